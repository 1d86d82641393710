// The nearest point of a solid's surface.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/geometry.hpp"
#include "triangle_tree.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Of the triangles that it is shown, in the surface's frame. Refers to the surface: it must stay.
class NearestTriangle {
 public:
  /// Triangles further away from `point` than `reach` do not count.
  NearestTriangle(const Surface& surface, const btVector3& point, btScalar reach)
      : surface_(surface), point_(point), best2_(reach * reach) {}

  /// Squares of distances from the point: of a box, and that beyond which nothing is looked for.
  btScalar distance2(const TriangleTree::Box& box) const;
  btScalar farthest2() const;
  /// Shows it a triangle; farthest2() thereafter.
  btScalar test(std::size_t triangle);

  bool found() const { return found_; }
  /// Only if found(): of the point from the surface [m], negative inside the solid.
  btScalar distance() const;
  /// Unit, out of the solid, along the line from the nearest point.
  btVector3 normal() const;
  /// Of those that share the nearest point, the one seen from the steepest angle.
  std::size_t triangle() const { return triangle_; }
  /// It is seen from 15 degrees or more.
  bool beside() const;

 private:
  const Surface& surface_;
  const btVector3 point_;
  btScalar best2_;
  bool found_ = false;
  btScalar height_ = 0;
  btVector3 face_{0, 0, 0};
  std::size_t triangle_ = 0;
  btVector3 offset_{0, 0, 0};
  btVoronoiSimplexSolver solver_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
