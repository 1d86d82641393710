#include "convex_parts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "random.hpp"

namespace innersphere::demo {
namespace {

using Polygon = std::vector<Vec3d>;

constexpr double kPi = std::numbers::pi;
constexpr int kDeepest = 8;          // halvings: 256 parts at most
constexpr int kPairs = 400;          // of points, between which a part is looked at
constexpr double kAnyWay = kPi / 2;  // [rad] wider sectors are cut across, whatever is in them

/// What the solid's surface leaves in a sector and layer.
struct Part {
  std::vector<Polygon> polygons;
  double angle_from = -kPi, angle_to = kPi, low = 0, high = 0;
  double concavity = 0;
};

/// The half of a polygon where `height` is at least 0.
template <typename Height>
Polygon above(const Polygon& polygon, const Height& height) {
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double a = height(p), b = height(q);
    if (a >= 0) result.push_back(p);
    if ((a > 0 && b < 0) || (a < 0 && b > 0)) {
      const double t = a / (a - b);
      result.push_back({p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]), p[2] + t * (q[2] - p[2])});
    }
  }
  return result;
}

template <typename Height>
std::vector<Polygon> allAbove(const std::vector<Polygon>& polygons, const Height& height) {
  std::vector<Polygon> result;
  for (const Polygon& polygon : polygons) {
    if (Polygon half = above(polygon, height); half.size() > 2) result.push_back(std::move(half));
  }
  return result;
}

class Cutter {
 public:
  Cutter(const Solid& solid, double concavity) : solid_(solid), concavity_(concavity), box_(solid.bounds()) {}

  std::vector<Part> run() {
    Part all;
    all.low = box_.min[2];
    all.high = box_.max[2];
    const Mesh mesh = solid_.surface();
    for (const auto& t : mesh.triangles) {
      all.polygons.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
    }
    cut(measured(std::move(all)), 0);
    return std::move(done_);
  }

 private:
  /// How far the middle between two points of the part is outside of the solid, at the most.
  Part measured(Part part) const {
    std::vector<Vec3d> points;
    for (const Polygon& polygon : part.polygons) points.insert(points.end(), polygon.begin(), polygon.end());
    Random random(1);
    const auto any = [&]() -> const Vec3d& {
      const auto index = static_cast<std::size_t>(random.between(0, static_cast<double>(points.size())));
      return points[std::min(index, points.size() - 1)];
    };
    for (int i = 0; i < kPairs && !points.empty(); ++i) {
      const Vec3d &a = any(), &b = any();
      const Vec3d middle{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
      if (!solid_.contains(middle)) {
        part.concavity = std::max(part.concavity, solid_.closestPoint(middle).distance);
      }
    }
    return part;
  }

  std::array<Part, 2> acrossTheAngle(const Part& part) const {
    const double middle = (part.angle_from + part.angle_to) / 2;
    const double c = std::cos(middle), s = std::sin(middle);
    const double x = (box_.min[0] + box_.max[0]) / 2, y = (box_.min[1] + box_.max[1]) / 2;
    const auto side = [=](const Vec3d& p) { return c * (p[1] - y) - s * (p[0] - x); };
    Part before = part, after = part;
    before.polygons = allAbove(part.polygons, [&](const Vec3d& p) { return -side(p); });
    after.polygons = allAbove(part.polygons, side);
    before.angle_to = after.angle_from = middle;
    return halves(std::move(before), std::move(after));
  }

  std::array<Part, 2> acrossTheHeight(const Part& part) const {
    const double middle = (part.low + part.high) / 2;
    Part below = part, over = part;
    below.polygons = allAbove(part.polygons, [=](const Vec3d& p) { return middle - p[2]; });
    over.polygons = allAbove(part.polygons, [=](const Vec3d& p) { return p[2] - middle; });
    below.high = over.low = middle;
    return halves(std::move(below), std::move(over));
  }

  std::array<Part, 2> halves(Part a, Part b) const {
    a.concavity = b.concavity = 0;
    return {measured(std::move(a)), measured(std::move(b))};
  }

  void cut(const Part& part, int depth) {
    if (part.polygons.empty()) return;
    if (part.concavity <= concavity_ || depth == kDeepest) {
      done_.push_back(part);
      return;
    }
    std::array<Part, 2> best = acrossTheAngle(part);
    if (part.angle_to - part.angle_from <= kAnyWay * (1 + 1e-9)) {
      std::array<Part, 2> other = acrossTheHeight(part);
      if (other[0].concavity + other[1].concavity < best[0].concavity + best[1].concavity)
        best = std::move(other);
    }
    for (const Part& half : best) cut(half, depth + 1);
  }

  const Solid& solid_;
  double concavity_;
  Bounds box_;
  std::vector<Part> done_;
};

}  // namespace

std::vector<std::vector<Vec3d>> convexParts(const Solid& solid, double concavity) {
  std::vector<std::vector<Vec3d>> result;
  for (const Part& part : Cutter(solid, concavity).run()) {
    std::vector<Vec3d>& points = result.emplace_back();
    for (const Polygon& polygon : part.polygons) points.insert(points.end(), polygon.begin(), polygon.end());
  }
  return result;
}

}  // namespace innersphere::demo
