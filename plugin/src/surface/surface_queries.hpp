// Searches on a solid's surface.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include <LinearMath/btVector3.h>

#include "common/lazy.hpp"
#include "innersphere/bullet_precision.hpp"
#include "innersphere/geometry.hpp"
#include "surface/smooth_normals.hpp"
#include "surface/triangle_bvh.hpp"

class btTriangleCallback;

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Returns the diagonal of the box around a surface that has vertices [m].
btScalar diagonalOf(const Surface& surface);

/// Answers in the surface's frame and its lengths. The surface must outlive it. Const members are safe to
/// call from several threads at once.
class SurfaceQueries {
 public:
  explicit SurfaceQueries(const Surface& surface);

  /// Calls back with all triangles that meet a box, and some near it.
  void processTriangles(btTriangleCallback* callback, const btVector3& min, const btVector3& max) const;

  /// Says where a ray meets the surface first: the curved one that the triangles stand for, see
  /// SmoothNormals.
  struct Hit {
    std::size_t triangle;
    btScalar distance;   ///< [m] along the ray
    btVector3 face;      ///< unit normal of the triangle, out of the solid
    btVector3 normal;    ///< the same, smoothed over curved surfaces
    btScalar curvature;  ///< there [1/m]; see SmoothNormals
  };
  /// Finds where a ray meets the surface. `direction` is a unit vector. Returns false if nothing is met
  /// within `length` [m]. On an edge it is the triangle whose normal points most along `towards`.
  bool cast(const btVector3& from, const btVector3& direction, btScalar length, const btVector3& towards,
            Hit& hit) const;
  /// Does the same for a triangle, or others around it on the same face, and for the line on both sides of
  /// `from`: the distance is negative behind it. Nothing in between is looked at.
  bool castNear(std::size_t triangle, const btVector3& from, const btVector3& direction, btScalar length,
                Hit& hit) const;

  /// Whether the solid is thinner than this [m] below a place of its surface: the normal, drawn inwards,
  /// comes out of a face that looks the other way.
  bool isThinner(btScalar thickness, const btVector3& place, const btVector3& normal) const;
  /// Does the same for a place on `triangle`. What is found out about a flat one is kept: below most there is
  /// nothing, and then no line is drawn.
  bool isThinner(btScalar thickness, std::size_t triangle, const btVector3& place,
                 const btVector3& normal) const;

  struct Nearest {
    btScalar distance;  ///< [m], negative inside the solid
    /// Unit, out of the solid, along the line from the nearest point; of the face within rounding of that.
    btVector3 normal;
    std::size_t triangle;
    bool beside;  ///< the nearest point is on an edge, which the triangle shares with another face
  };
  /// Finds the nearest point. Returns false if the surface is further away from `point` than `max_distance`
  /// [m].
  bool nearest(const btVector3& point, btScalar max_distance, Nearest& result) const;

  const SmoothNormals& normals() const {
    return normals_.get([this] { return std::make_unique<SmoothNormals>(surface_); });
  }
  /// Returns how far off places on its triangles may be, for rounding [m].
  btScalar rounding() const { return tree_.rounding(); }

 private:
  bool isOpposedBelow(btScalar thickness, std::size_t triangle) const;

  const Surface& surface_;
  TriangleBvh tree_;
  Lazy<SmoothNormals> normals_;
  /// How far below each triangle no other looks the other way, as far as that is known [m]; negative if one
  /// may be near.
  mutable std::vector<std::atomic<btScalar>> open_below_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
