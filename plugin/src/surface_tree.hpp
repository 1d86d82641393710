// Triangles of a solid's surface in a bounding volume tree.
#pragma once

#include <memory>

#include <LinearMath/btVector3.h>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/geometry.hpp"
#include "lazy.hpp"
#include "smooth_normals.hpp"

class btBvhTriangleMeshShape;
class btTriangleCallback;
class btTriangleIndexVertexArray;

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Bullet's own quantised tree over a Surface, in the surface's frame. Refers to the surface's arrays: they
/// must stay. Const members are safe to call from several threads at once.
class SurfaceTree {
 public:
  explicit SurfaceTree(const Surface& surface);
  ~SurfaceTree();

  void processTriangles(btTriangleCallback* callback, const btVector3& min, const btVector3& max) const;

  /// Where a ray meets the surface first: the curved one that the triangles stand for, see SmoothNormals.
  struct Hit {
    std::size_t triangle;
    btScalar distance;   ///< [m] along the ray
    btVector3 face;      ///< unit normal of the triangle, out of the solid
    btVector3 normal;    ///< the same, smoothed over curved surfaces
    btScalar curvature;  ///< there [1/m]; see SmoothNormals
  };
  /// `direction` is a unit vector. False if nothing is met within `length`.
  bool cast(const btVector3& from, const btVector3& direction, btScalar length, Hit& hit) const;
  /// The same for one triangle and the line on both sides of `from`: the distance is negative behind it.
  bool castAt(std::size_t triangle, const btVector3& from, const btVector3& direction, btScalar length,
              Hit& hit) const;
  /// See SmoothNormals.
  btScalar untilSharpEdge(std::size_t triangle, const btVector3& point, const btVector3& towards,
                          btScalar farthest) const;

 private:
  const SmoothNormals& normals() const;
  void complete(const btVector3& from, const btVector3& direction, Hit& hit) const;

  const Surface& surface_;
  Lazy<SmoothNormals> normals_;
  std::unique_ptr<btTriangleIndexVertexArray> triangles_;
  std::unique_ptr<btBvhTriangleMeshShape> tree_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
