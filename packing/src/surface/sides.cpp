#include "surface/sides.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "surface/box.hpp"

namespace innersphere {

namespace {

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
  return cross(wide(t.corner(1) - t.corner(0)), wide(t.corner(2) - t.corner(0)));
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

/// Returns what EdgeOrder::comesBefore() does, exactly.
bool isBefore(const GridTriangle& t, const Corners& at_u, bool from_alone_t, const GridTriangle& u,
              const Corners& at_t, bool from_alone_u) {
  // From a, above u, down to b, and from c, above t, down to d.
  int a = at_u.alone, b = at_u.far(from_alone_t), c = at_t.alone, d = at_t.far(from_alone_u);
  if (!at_u.isAbove(a)) std::swap(a, b);
  if (!at_t.isAbove(c)) std::swap(c, d);
  const Vec3d from_t = t.corner(a), from_u = u.corner(c), to_u = u.corner(d);
  const WideVector along = wide(t.corner(b) - from_t);
  const Wide exact = dot(cross(along, wide(from_u - from_t)), wide(to_u - from_t));
  if (exact != 0) return exact > 0;
  return signAlongMove(cross(along, wide(from_u - to_u))) > 0;
}

}  // namespace

bool GridTriangle::isAbove(const Vec3d& point, Moved moved) const {
  const WideVector exact_normal = exactNormal(*this);
  const Wide exact = dot(exact_normal, wide(point - corner(0)));
  if (exact != 0) return exact > 0;
  return (signAlongMove(exact_normal) > 0) == (moved == Moved::point);
}

void EdgeOrder::decide(const GridTriangle& t, const Corners& at_u, const GridTriangle& u, const Corners& at_t,
                       unsigned known) {
  for (const bool from_t : {true, false}) {
    for (const bool from_u : {true, false}) {
      if ((known >> bit(from_t, from_u) & 1) != 0) continue;
      if (isBefore(t, at_u, from_t, u, at_t, from_u)) before_ |= 1U << bit(from_t, from_u);
    }
  }
}

int windingSeen(const GridTriangle& triangle, const Vec3d& point, Moved moved, bool up) {
  const Vec3d a = triangle.corner(0), b = triangle.corner(1), c = triangle.corner(2);
  const bool left = isLeft(a, b, point, moved);
  if (isLeft(b, c, point, moved) != left || isLeft(c, a, point, moved) != left) return 0;
  const int side = facing(triangle);
  if (side == 0 || (side > 0) != left) return 0;
  const double height = triangle.height(point.x, point.y, point.z);
  const bool above =
      std::abs(height) > triangle.heightRounding() ? height > 0 : triangle.isAbove(point, moved);
  const bool is_up = above != (side > 0);
  return is_up != up ? 0 : up ? side : -side;
}

}  // namespace innersphere
