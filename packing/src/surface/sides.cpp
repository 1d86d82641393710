#include "surface/sides.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "surface/box.hpp"

namespace innersphere {

namespace {

/// Half the distance from 1 to the next number.
constexpr double kUnit = 0x1p-53;
/// Bounds of rounding: of a sum of three products of differences, and of one difference of two products.
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

/// Returns whether a point is above a triangle, from its height, which is known but for `bound`.
bool isAbove(double height, double bound, const Vec3d& point, const GridTriangle& t, Moved moved) {
  if (std::abs(height) > bound) return height > 0;
  const WideVector normal = exactNormal(t);
  const Wide exact = dot(normal, wide(point - t.corners[0]));
  if (exact != 0) return exact > 0;
  return (signAlongMove(normal) > 0) == (moved == Moved::point);
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
  size = std::max(size_b, size_c);
  rounding = kRounding3 * size_b * size_c;
}

Corners cornersAbove(const GridTriangle& plane, const GridTriangle& triangle, Moved moved) {
  const Vec3d first = triangle.corners[0] - plane.corners[0];
  const double bound = plane.rounding * (largest(first) + triangle.size);
  Corners corners;
  for (int k = 0; k < 3; ++k) {
    const double height = dot(plane.normal, triangle.corners[k] - plane.corners[0]);
    corners.heights[k] = height;
    corners.above[k] = isAbove(height, bound, triangle.corners[k], plane, moved);
  }
  const bool* above = corners.above;
  if (above[0] == above[1]) {
    corners.alone = above[0] == above[2] ? -1 : 2;
  } else {
    corners.alone = above[2] == above[1] ? 0 : 1;
  }
  return corners;
}

EdgeOrder::EdgeOrder(const GridTriangle& t, const Corners& at_u, const GridTriangle& u, const Corners& at_t)
    : t_(t), u_(u), at_u_(at_u), at_t_(at_t) {
  // No way from a corner of t to one of u is longer; and an edge between the others is up to twice the size.
  const double farthest = largest(u.corners[0] - t.corners[0]) + t.size + u.size;
  rounding_ = kRounding3 * 2 * t.size * farthest * farthest;
}

bool EdgeOrder::comesBefore(int of_t, int of_u) const {
  // From a, above u, down to b, and from c, above t, down to d.
  const int next_t = of_t < 2 ? of_t + 1 : 0, next_u = of_u < 2 ? of_u + 1 : 0;
  const bool falls_t = at_u_.above[of_t], falls_u = at_t_.above[of_u];
  const Vec3d &a = t_.corners[falls_t ? of_t : next_t], &b = t_.corners[falls_t ? next_t : of_t],
              &c = u_.corners[falls_u ? of_u : next_u], &d = u_.corners[falls_u ? next_u : of_u];
  const double volume = dot(innersphere::cross(b - a, c - a), d - a);
  if (std::abs(volume) > rounding_) return volume > 0;
  const WideVector along = wide(b - a);
  const Wide exact = dot(cross(along, wide(c - a)), wide(d - a));
  if (exact != 0) return exact > 0;
  return signAlongMove(cross(along, wide(c - d))) > 0;
}

int windingBelow(const GridTriangle& triangle, const Vec3d& point, Moved moved) {
  const Vec3d* c = triangle.corners;
  const bool left = isLeft(c[0], c[1], point, moved);
  if (isLeft(c[1], c[2], point, moved) != left || isLeft(c[2], c[0], point, moved) != left) return 0;
  const int side = facing(triangle);
  if (side == 0 || (side > 0) != left) return 0;
  const Vec3d to = point - c[0];
  const bool above =
      isAbove(dot(triangle.normal, to), triangle.rounding * largest(to), point, triangle, moved);
  return above == (side > 0) ? 0 : side;
}

}  // namespace innersphere
