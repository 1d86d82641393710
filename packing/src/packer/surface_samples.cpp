#include "packer/surface_samples.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "packer/near_balls.hpp"

namespace innersphere {
namespace {

constexpr std::size_t kSurfacePoints = 50000;

// Steps of the two-dimensional sequence with the most even spread known (Roberts' R2): 1/p and 1/p^2, where
// p^3 = p + 1.
constexpr double kStepU = 0.7548776662466927;
constexpr double kStepV = 0.5698402909980532;

}  // namespace

SurfaceSamples::SurfaceSamples(const Mesh& surface, const Container& container) {
  const auto corner = [&](std::size_t triangle, int k) {
    return container.fromWorld(surface.vertices[surface.triangles[triangle][k]]);
  };
  std::vector<double> area(surface.triangles.size());
  std::vector<Point> inwards(area.size());
  for (std::size_t t = 0; t < area.size(); ++t) {
    const Point a = corner(t, 0), ab = corner(t, 1) - a, ac = corner(t, 2) - a;
    const Point cross(ab[1] * ac[2] - ab[2] * ac[1], ab[2] * ac[0] - ab[0] * ac[2],
                      ab[0] * ac[1] - ab[1] * ac[0]);
    area[t] = cross.norm() / 2;
    if (area[t] > 0) inwards[t] = -cross / (2 * area[t]);
  }
  const double total = std::accumulate(area.begin(), area.end(), 0.0);
  if (!(total > 0)) return;
  std::size_t triangle = 0;
  double before = 0;
  for (std::size_t i = 0; i < kSurfacePoints; ++i) {
    const double target = (static_cast<double>(i) + 0.5) / kSurfacePoints * total;
    while (triangle + 1 < area.size() && before + area[triangle] < target) before += area[triangle++];
    double u = std::fmod(static_cast<double>(i + 1) * kStepU, 1.0),
           v = std::fmod(static_cast<double>(i + 1) * kStepV, 1.0);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const Point a = corner(triangle, 0);
    points_.push_back(a + u * (corner(triangle, 1) - a) + v * (corner(triangle, 2) - a));
    inwards_.push_back(inwards[triangle]);
  }
}

bool SurfaceSamples::touchedByBall(const Container& container, double radius) const {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point centre = points_[i] + radius * inwards_[i];
    const double empty = radius * (1 - 1e-6) - container.margin();
    if (std::isinf(container.closest(centre, empty).distance) && container.contains(centre)) return true;
  }
  return false;
}

bool SurfaceSamples::covered(const SphereGrid& grid, double gap, std::size_t& first) const {
  while (first < points_.size() && grid.nearest(points_[first], gap).distance < gap) ++first;
  return first == points_.size();
}

std::optional<std::size_t> SurfaceSamples::prefixWithin(const SphereGrid& grid, double gap) const {
  std::size_t prefix = 0;
  for (const Point& x : points_) {
    std::size_t first = grid.balls().size();
    grid.visitNear(x, x, gap, [&](std::uint32_t i) {
      if (i < first && grid.balls()[i].distance(x) < gap) first = i;
    });
    if (first == grid.balls().size()) return std::nullopt;
    prefix = std::max(prefix, first + 1);
  }
  return prefix;
}

std::vector<Coverage> SurfaceSamples::coverage(std::span<const Ball> balls,
                                               std::span<const std::size_t> counts, double distance) const {
  std::vector<Coverage> prefixes;
  if (points_.empty()) return prefixes;
  std::vector<double> gaps(points_.size(), 2);  // farther than anything in the unit cube
  std::size_t known = 0;
  for (std::size_t count : counts) {
    const std::vector<NearBalls::Nearest> added = nearestBalls(points_, balls.subspan(known, count - known));
    known = count;
    for (std::size_t i = 0; i < gaps.size(); ++i)
      gaps[i] = std::min(gaps[i], std::max(0.0, added[i].distance));
    const auto size = static_cast<double>(gaps.size());
    Coverage& now = prefixes.emplace_back();
    now.count = static_cast<std::uint32_t>(count);
    now.mean = std::accumulate(gaps.begin(), gaps.end(), 0.0) / size;
    const auto farthest = std::max_element(gaps.begin(), gaps.end());
    now.max = *farthest;
    const Point& at = points_[static_cast<std::size_t>(farthest - gaps.begin())];
    now.farthest = {at[0], at[1], at[2]};
    const auto beyond = std::count_if(gaps.begin(), gaps.end(), [&](double gap) { return gap > distance; });
    now.uncovered = static_cast<double>(beyond) / size;
    std::vector<double> ranked = gaps;
    const auto p95 = ranked.begin() + static_cast<std::ptrdiff_t>(ranked.size() * 95 / 100);
    std::nth_element(ranked.begin(), p95, ranked.end());
    now.p95 = *p95;
  }
  return prefixes;
}

}  // namespace innersphere
