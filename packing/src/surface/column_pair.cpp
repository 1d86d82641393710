#include "surface/column_pair.hpp"

#include <algorithm>
#include <cmath>

#include "surface/box.hpp"

namespace innersphere {

namespace {

/// A triangle whose normal has less of z than this is seen from its edge: its columns are as thin as
/// rounding.
constexpr double kEdgeOn = 1e-9;

/// This is a corner of the columns that two triangles have in common.
struct Corner {
  double x, y;
  double top, bottom;  ///< z of t and of u
  double depth() const { return top - bottom; }
};

Corner between(const Corner& a, const Corner& b, double of_b) {
  const double of_a = 1 - of_b;
  return {of_a * a.x + of_b * b.x, of_a * a.y + of_b * b.y, of_a * a.top + of_b * b.top,
          of_a * a.bottom + of_b * b.bottom};
}

constexpr int kMostCorners = 3 + 10;  ///< three sides, and one more for each cut

/// This is a convex polygon: a triangle that was cut by the sides of another, by those of a box and by a
/// plane.
struct Polygon {
  Corner corners[kMostCorners];
  int count;
};

/// Keeps the part of the polygon where `height`, which is linear, is not negative.
template <typename Height>
void cut(Polygon& polygon, const Height& height) {
  double heights[kMostCorners];
  int below = 0;
  for (int i = 0; i < polygon.count; ++i) {
    heights[i] = height(polygon.corners[i]);
    below += heights[i] < 0;
  }
  if (below == 0) return;
  const int count = polygon.count;
  polygon.count = 0;
  if (below == count) return;
  Corner corners[kMostCorners];
  std::copy(polygon.corners, polygon.corners + count, corners);
  for (int i = 0; i < count; ++i) {
    const int next = i + 1 < count ? i + 1 : 0;
    if (heights[i] >= 0) polygon.corners[polygon.count++] = corners[i];
    if ((heights[i] < 0) != (heights[next] < 0)) {
      polygon.corners[polygon.count++] =
          between(corners[i], corners[next], heights[i] / (heights[i] - heights[next]));
    }
  }
}

/// Returns the columns of the box that both triangles have, with t's heights.
Polygon commonColumns(const ColumnTriangle& t, const ColumnTriangle& u, const Bounds& box) {
  Polygon polygon;
  polygon.count = 3;
  for (int k = 0; k < 3; ++k) polygon.corners[k] = {t.corners[k].x, t.corners[k].y, t.corners[k].z, 0};
  for (int k = 0; k < 3 && polygon.count > 0; ++k) {
    const Vec3d &a = u.corners[k], &b = u.corners[k < 2 ? k + 1 : 0];
    const double dx = u.side * (b.x - a.x), dy = u.side * (b.y - a.y);
    cut(polygon, [&](const Corner& c) { return dx * (c.y - a.y) - dy * (c.x - a.x); });
  }
  if (t.box.min.x >= box.min.x && t.box.max.x <= box.max.x && t.box.min.y >= box.min.y &&
      t.box.max.y <= box.max.y)
    return polygon;
  cut(polygon, [&](const Corner& c) { return c.x - box.min.x; });
  cut(polygon, [&](const Corner& c) { return box.max.x - c.x; });
  cut(polygon, [&](const Corner& c) { return c.y - box.min.y; });
  cut(polygon, [&](const Corner& c) { return box.max.y - c.y; });
  return polygon;
}

/// Holds integrals over a polygon.
struct Integrals {
  double area = 0, x = 0, y = 0, bottom = 0;                ///< of 1, x, y and bottom
  double depth = 0, depth_x = 0, depth_y = 0, depth_z = 0;  ///< of depth, times x, y and the middle height
};

Integrals integrate(const Polygon& polygon) {
  Integrals sums;
  const Corner& a = polygon.corners[0];
  for (int k = 1; k + 1 < polygon.count; ++k) {
    const Corner &b = polygon.corners[k], &c = polygon.corners[k + 1];
    const double area = std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
    const double da = a.depth(), db = b.depth(), dc = c.depth(), d = da + db + dc;
    const auto product = [&](double fa, double fb, double fc) {
      return area / 12 * (d * (fa + fb + fc) + da * fa + db * fb + dc * fc);
    };
    sums.area += area;
    sums.x += area / 3 * (a.x + b.x + c.x);
    sums.y += area / 3 * (a.y + b.y + c.y);
    sums.bottom += area / 3 * (a.bottom + b.bottom + c.bottom);
    sums.depth += area / 3 * d;
    sums.depth_x += product(a.x, b.x, c.x);
    sums.depth_y += product(a.y, b.y, c.y);
    sums.depth_z += product((a.top + a.bottom) / 2, (b.top + b.bottom) / 2, (c.top + c.bottom) / 2);
  }
  return sums;
}

/// Adds the columns between t and u over a polygon; `with_surface` also u itself.
void addColumns(Polygon polygon, const ColumnTriangle& t, const ColumnTriangle& u, bool with_surface,
                SharedSums& sums) {
  cut(polygon, [](const Corner& c) { return c.depth(); });
  if (polygon.count < 3) return;
  const Integrals of = integrate(polygon);
  const int sign = -t.side * u.side;
  sums.volume += sign * of.depth;
  sums.magnitude += of.depth;
  sums.moment = sums.moment + double(sign) * Vec3d{of.depth_x, of.depth_y, of.depth_z};
  if (!with_surface) return;
  const Vec3d normal = t.side / std::abs(u.normal.z) * u.normal;
  sums.area = sums.area + of.area * normal;
  sums.turning = sums.turning + cross(Vec3d{of.x, of.y, of.bottom}, normal);
  sums.wetted += t.side * of.area * norm(u.normal) / std::abs(u.normal.z);
}

/// The same, without what is below `low`.
void addAbove(double low, Polygon polygon, const ColumnTriangle& t, const ColumnTriangle& u,
              SharedSums& sums) {
  if (u.box.min.z < low) {
    Polygon below = polygon;
    cut(below, [&](const Corner& c) { return low - c.bottom; });
    for (int k = 0; k < below.count; ++k) below.corners[k].bottom = low;
    addColumns(below, t, u, false, sums);
    cut(polygon, [&](const Corner& c) { return c.bottom - low; });
  }
  addColumns(polygon, t, u, true, sums);
}

}  // namespace

ColumnTriangle makeColumnTriangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  ColumnTriangle t{{a, b, c}, {a, a}, cross(b - a, c - a), 0};
  include({b, b}, t.box);
  include({c, c}, t.box);
  if (std::abs(t.normal.z) > kEdgeOn * norm(t.normal)) t.side = t.normal.z > 0 ? 1 : -1;
  return t;
}

void addColumnPair(const ColumnTriangle& t, const ColumnTriangle& u, const Bounds& box, SharedSums& sums) {
  Polygon polygon = commonColumns(t, u, box);
  if (polygon.count < 3) return;
  const Vec3d& place = u.corners[0];
  for (int k = 0; k < polygon.count; ++k) {
    Corner& c = polygon.corners[k];
    // Bounded, because the plane of a steep triangle is far from it already beside its edges.
    const double z = place.z - (u.normal.x * (c.x - place.x) + u.normal.y * (c.y - place.y)) / u.normal.z;
    c.bottom = std::clamp(z, u.box.min.z, u.box.max.z);
  }
  if (t.box.max.z > box.max.z) {
    Polygon above = polygon;
    cut(above, [&](const Corner& c) { return c.top - box.max.z; });
    for (int k = 0; k < above.count; ++k) above.corners[k].top = box.max.z;
    addAbove(box.min.z, above, t, u, sums);
    cut(polygon, [&](const Corner& c) { return box.max.z - c.top; });
  }
  addAbove(box.min.z, polygon, t, u, sums);
}

}  // namespace innersphere
