#include "surface/nearest_triangle.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

constexpr btScalar kOver = btScalar(0.966);  // cos 15 degrees

}  // namespace

btScalar NearestTriangle::test(std::size_t t) {
  const btVector3& face = triangles_.face(t);
  if (face.isZero()) return farthest2();
  const btVector3* const corners = triangles_.corners(t);
  btSubSimplexClosestResult closest;
  closest.reset();
  solver_.closestPtPointTriangle(point_, corners[0], corners[1], corners[2], closest);
  const btVector3 offset = point_ - closest.m_closestPointOnSimplex;
  const btScalar length2 = offset.length2();
  if (length2 > farthest2()) return farthest2();
  // Of those that share the nearest point, the one seen from the steepest angle tells inside from outside.
  const btScalar height = offset.dot(face);
  const bool shared = found_ && length2 >= best2_ * (1 - kSame);
  const bool steeper =
      btFabs(height) > btFabs(height_) || (btFabs(height) == btFabs(height_) && t < triangle_);
  if (!shared || steeper) {
    height_ = height;
    face_ = face;
    triangle_ = t;
  }
  if (length2 < best2_ || !found_) {
    best2_ = length2;
    offset_ = offset;
  }
  found_ = true;
  return farthest2();
}

btScalar NearestTriangle::distance() const {
  return height_ < 0 ? -btSqrt(best2_) : btSqrt(best2_);
}

btVector3 NearestTriangle::normal() const {
  return btSqrt(best2_) > SIMD_EPSILON ? offset_ / distance() : face_;
}

bool NearestTriangle::beside() const {
  return btFabs(height_) < kOver * btSqrt(best2_);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
