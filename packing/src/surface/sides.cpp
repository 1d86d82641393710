#include "surface/sides.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "surface/box.hpp"

namespace innersphere {

namespace {

/// Half the distance from 1 to the next number.
constexpr double kUnit = 0x1p-53;
/// Bounds of rounding: of a sum of three products of differences, and of one difference of two products. That of a
/// height is 2 * kGridBits times as large as
constexpr double kRounding3 = 32 * kUnit, kRounding2 = 4 * kUnit;

using Wide = __int128;
struct WideVector {
  Wide x, y, z;
};

/// Coordinates are whole numbers.
WideVector wide(const Vec3d& v) {
  return {static_cast<std::int64_t>(v.x), static_cast<std::int64_t>(v.y), static_cast<std::int64_t>(v.z)};
}

WideVector cross(const WideVector& a, const WideVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Wide dot(const WideVector& a, const WideVector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Returns the sign of the product with d: of the first component that is not zero.
int signAlongMove(const WideVector& v) {
  for (const Wide component : {v.x, v.y, v.z}) {
    if (component != 0) return component > 0 ? 1 : -1;
  }
  return 0;
}

WideVector exactNormal(const GridTriangle& t) {
  return cross(wide(t.corners[1] - t.corners[0]), wide(t.corners[2] - t.corners[0]));
}

/// Returns whether a point is to the left of the way from a to b, seen from above.
bool isLeft(const Vec3d& a, const Vec3d& b, const Vec3d& point, Moved moved) {
  const Vec3d along = b - a, to = point - a;
  const double left = along.x * to.y - along.y * to.x;
  const double bound = kRounding2 * largest(along) * largest(to);
  if (std::abs(left) > bound) return left > 0;
  const WideVector e = wide(along), p = wide(to);
  const Wide exact = e.x * p.y - e.y * p.x;
  if (exact != 0) return exact > 0;
  return (e.y != 0 ? e.y < 0 : e.x > 0) == (moved == Moved::point);
}

/// Returns the sign of the normal's z.
int facing(const GridTriangle& t) {
  if (std::abs(t.normal.z) > t.rounding) return t.normal.z > 0 ? 1 : -1;
  const Wide z = exactNormal(t).z;
  return z == 0 ? 0 : z > 0 ? 1 : -1;
}

}  // namespace

GridTriangle::GridTriangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) : corners{a, b, c} {
  const Vec3d to_b = b - a, to_c = c - a;
  const double size_b = largest(to_b), size_c = largest(to_c);
  normal = innersphere::cross(to_b, to_c);
  offset = dot(normal, a);
  size = std::max(size_b, size_c);
  rounding = kRounding2 * size_b * size_c;
}

bool GridTriangle::isAbove(const Vec3d& point, Moved moved) const {
  const WideVector exact_normal = exactNormal(*this);
  const Wide exact = dot(exact_normal, wide(point - corners[0]));
  if (exact != 0) return exact > 0;
  return (signAlongMove(exact_normal) > 0) == (moved == Moved::point);
}

EdgeOrder::EdgeOrder(const GridTriangle& t, const Corners& at_u, const GridTriangle& u, const Corners& at_t)
    : t_(t), u_(u), at_u_(at_u), at_t_(at_t), alone_(t.corners[at_u.alone]) {
  const Vec3d to_alone = u.corners[at_t.alone] - alone_;
  for (const int from : {0, 1})
    to_u_[from] = innersphere::cross(to_alone, u.corners[at_t.far(from == 1)] - alone_);
  // No way from a corner of t to one of u is longer; and an edge between the others is up to twice the size.
  const double farthest = largest(u.corners[0] - t.corners[0]) + t.size + u.size;
  rounding_ = kRounding3 * 2 * t.size * farthest * farthest;
}

bool EdgeOrder::comesBeforeExactly(bool from_alone_t, bool from_alone_u) const {
  // From a, above u, down to b, and from c, above t, down to d.
  int a = at_u_.alone, b = at_u_.far(from_alone_t), c = at_t_.alone, d = at_t_.far(from_alone_u);
  if (!at_u_.isAbove(a)) std::swap(a, b);
  if (!at_t_.isAbove(c)) std::swap(c, d);
  const Vec3d &from_t = t_.corners[a], &from_u = u_.corners[c], &to_u = u_.corners[d];
  const WideVector along = wide(t_.corners[b] - from_t);
  const Wide exact = dot(cross(along, wide(from_u - from_t)), wide(to_u - from_t));
  if (exact != 0) return exact > 0;
  return signAlongMove(cross(along, wide(from_u - to_u))) > 0;
}

int windingBelow(const GridTriangle& triangle, const Vec3d& point, Moved moved) {
  const Vec3d* c = triangle.corners;
  const bool left = isLeft(c[0], c[1], point, moved);
  if (isLeft(c[1], c[2], point, moved) != left || isLeft(c[2], c[0], point, moved) != left) return 0;
  const int side = facing(triangle);
  if (side == 0 || (side > 0) != left) return 0;
  const bool above = triangle.isAbove(triangle.height(point), point, moved);
  return above == (side > 0) ? 0 : side;
}

}  // namespace innersphere
