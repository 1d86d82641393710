#include "nearest_triangle.hpp"

#include "vec.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Triangles whose nearest points differ by less than this fraction of the distance share them.
constexpr btScalar kSame = btScalar(1e-5);
constexpr btScalar kOver = btScalar(0.966);  // cos 15 degrees

}  // namespace

btScalar NearestTriangle::distance2(const TriangleTree::Box& box) const {
  btScalar sum = 0;
  for (int k = 0; k < 3; ++k) {
    const btScalar outside = btMax(btMax(box.min[k] - point_[k], point_[k] - box.max[k]), btScalar(0));
    sum += outside * outside;
  }
  return sum;
}

btScalar NearestTriangle::farthest2() const {
  return best2_ * (1 + kSame);
}

btScalar NearestTriangle::test(std::size_t t) {
  btVector3 v[3];
  for (int k = 0; k < 3; ++k) v[k] = toBullet(surface_.vertices[surface_.triangles[t][k]]);
  const btVector3 normal = (v[1] - v[0]).cross(v[2] - v[0]);
  if (!(normal.length2() > 0)) return farthest2();
  btSubSimplexClosestResult closest;
  closest.reset();
  solver_.closestPtPointTriangle(point_, v[0], v[1], v[2], closest);
  const btVector3 offset = point_ - closest.m_closestPointOnSimplex;
  const btScalar length2 = offset.length2();
  if (length2 > farthest2()) return farthest2();
  // Of those that share the nearest point, the one seen from the steepest angle tells inside from outside.
  const btVector3 face = normal.normalized();
  const btScalar height = offset.dot(face);
  const bool shared = found_ && length2 >= best2_ * (1 - kSame);
  if (!shared || btFabs(height) > btFabs(height_)) {
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
