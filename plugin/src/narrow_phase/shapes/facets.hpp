// Holds the flat faces of a shape that is no packing, as triangles that know their neighbours.
#pragma once

#include <memory>
#include <vector>

#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <BulletCollision/CollisionShapes/btPolyhedralConvexShape.h>

#include "shape/sharp_edges.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Holds the faces, which are made anew only where the points that they are made of have changed.
class Facets {
 public:
  /// Notes that it is time to look at the shape again.
  void expire() { expired_ = true; }
  bool isExpired() const { return expired_; }
  /// Takes a mesh's triangles in a box, and some around it.
  void setMesh(const btConcaveShape& mesh, const btVector3& min, const btVector3& max);
  /// Takes the hull of a polyhedron's vertices, which the shape may exceed by a margin on all sides.
  void setHull(const btPolyhedralConvexShape& shape);

  /// Places the faces relative to a place, in axes of the world. Returns false if there are none.
  bool place(const btTransform& world, const btVector3& relative_to, SharpEdges& solid) const;
  struct Nearest {
    btScalar distance;        ///< [m], negative inside
    btVector3 normal;         ///< unit, out of the hull
    btScalar edge_curvature;  ///< of the edge or corner there [1/m]; 0 if it is inside of a face
    btVector3 along;          ///< unit, along the edge; 0 if it is none
  };
  /// Finds the point of a hull with its margin that is nearest to a place, in the frame of the shape. Returns
  /// false if the hull has no inside.
  bool nearest(const btVector3& place, Nearest& nearest) const;

 private:
  bool set(const std::vector<btVector3>& points, Surface (*make)(const std::vector<btVector3>&));

  bool expired_ = true;
  std::vector<btVector3> points_;  ///< in the frame of the shape
  btVector3 min_{0, 0, 0};         ///< where a mesh's come from
  btVector3 max_{0, 0, 0};
  Surface surface_;
  std::unique_ptr<SurfaceQueries> tree_;
  btScalar margin_ = 0;    ///< [m]
  bool is_solid_ = false;  ///< it is a hull with an inside
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
