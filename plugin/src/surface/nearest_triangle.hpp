// The nearest point of a solid's surface.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include "innersphere/bullet_precision.hpp"
#include "surface/smooth_normals.hpp"
#include "surface/triangle_bvh.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Of the triangles that it is shown, in the surface's frame. Refers to them: they must stay.
class NearestTriangle {
 public:
  /// Triangles further away from `point` than `max_distance` do not count.
  NearestTriangle(const SmoothNormals& triangles, const btVector3& point, btScalar max_distance)
      : triangles_(triangles), point_(point), best2_(max_distance * max_distance) {}

  /// Squares of distances from the point: of boxes, and that beyond which nothing is looked for.
  TriangleBvh::Lanes distances2(const TriangleBvh::Boxes& boxes) const;
  btScalar farthest2() const { return best2_ * (1 + kSame); }
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
  /// Triangles whose nearest points differ by less than this fraction of the distance share them.
  static constexpr btScalar kSame = btScalar(1e-5);

  const SmoothNormals& triangles_;
  const btVector3 point_;
  btScalar best2_;
  bool found_ = false;
  btScalar height_ = 0;
  btVector3 face_{0, 0, 0};
  std::size_t triangle_ = 0;
  btVector3 offset_{0, 0, 0};
  btVoronoiSimplexSolver solver_;
};

inline TriangleBvh::Lanes NearestTriangle::distances2(const TriangleBvh::Boxes& boxes) const {
  TriangleBvh::Lanes sum{};
  for (int k = 0; k < 3; ++k) {
    const float at = static_cast<float>(point_[k]);
    const TriangleBvh::Lanes outside = TriangleBvh::greater(boxes.min[k] - at, at - boxes.max[k]);
    const TriangleBvh::Lanes gap = TriangleBvh::greater(outside, TriangleBvh::Lanes{});
    sum += gap * gap;
  }
  return sum;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
