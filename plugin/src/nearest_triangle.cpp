#include "nearest_triangle.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

constexpr btScalar kOver = btScalar(0.966);  // cos 15 degrees

/// Of a triangle. C. Ericson, Real-Time Collision Detection, 5.1.5; as Bullet has it, which keeps more of it.
btVector3 nearestPoint(const btVector3* corners, const btVector3& point) {
  const btVector3 &a = corners[0], &b = corners[1], &c = corners[2];
  const btVector3 ab = b - a, ac = c - a;
  const btVector3 ap = point - a;
  const btScalar d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const btVector3 bp = point - b;
  const btScalar d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const btScalar vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const btVector3 cp = point - c;
  const btScalar d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const btScalar vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const btScalar va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const btScalar denominator = 1 / (va + vb + vc);
  return a + ab * (vb * denominator) + ac * (vc * denominator);
}

}  // namespace

btScalar NearestTriangle::test(std::size_t t) {
  const btVector3& face = triangles_.face(t);
  if (face.isZero()) return farthest2();
  const btVector3 offset = point_ - nearestPoint(triangles_.corners(t), point_);
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
