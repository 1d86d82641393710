#include "grid/grid_plan.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace innersphere {

using core::GridPlan;

namespace {

constexpr double kListed = 8;  ///< cells of the finest grid level that list a sphere, on average, at most
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Adds all spheres up in some order, which must not matter: `Sum` has add(sphere) and add(other sum).
template <typename Sum>
Sum sumOf(const Sphere* spheres, std::size_t count, const Sum& none) {
  constexpr std::size_t kGrain = 4096;
  using Range = tbb::blocked_range<const Sphere*>;
  const auto of = [](const Range& range, Sum sum) {
    for (const Sphere& s : range) sum.add(s);
    return sum;
  };
  const Range all(spheres, spheres + count, kGrain);
  if (count <= kGrain) return of(all, none);
  return tbb::parallel_reduce(all, none, of, [](Sum a, const Sum& b) {
    a.add(b);
    return a;
  });
}

/// What holds all spheres, and how many of each level there are.
struct Measures {
  static constexpr int kLowest = -126;  ///< level of any radius
  Vec3d hi{-kInfinity, -kInfinity, -kInfinity}, minus_lo = hi;
  double reach2 = 0;  ///< of the centres, from the origin
  float smallest = std::numeric_limits<float>::max(), largest = 0;
  std::array<std::uint32_t, 256> levels{};

  void add(const Sphere& s) {
    const double x = s.x, y = s.y, z = s.z, r = s.radius;
    hi = {std::max(hi.x, x + r), std::max(hi.y, y + r), std::max(hi.z, z + r)};
    minus_lo = {std::max(minus_lo.x, r - x), std::max(minus_lo.y, r - y), std::max(minus_lo.z, r - z)};
    reach2 = std::max(reach2, x * x + y * y + z * z);
    smallest = std::min(smallest, s.radius);
    largest = std::max(largest, s.radius);
    ++levels[static_cast<std::size_t>(core::levelOf(s.radius) - kLowest)];
  }
  void add(const Measures& other) {
    const Vec3d &h = other.hi, &l = other.minus_lo;
    hi = {std::max(hi.x, h.x), std::max(hi.y, h.y), std::max(hi.z, h.z)};
    minus_lo = {std::max(minus_lo.x, l.x), std::max(minus_lo.y, l.y), std::max(minus_lo.z, l.z)};
    reach2 = std::max(reach2, other.reach2);
    smallest = std::min(smallest, other.smallest);
    largest = std::max(largest, other.largest);
    for (std::size_t level = 0; level < levels.size(); ++level) levels[level] += other.levels[level];
  }
};

/// Half the box and the radius of the ball around all spheres. Measured from the rounded centre, so that
/// nothing of a small sphere far from the origin is lost.
struct Extent {
  Vec3d centre;
  Vec3d half{0, 0, 0};
  double radius = 0;

  void add(const Sphere& s) {
    const Vec3d d = Vec3d{s.x, s.y, s.z} - centre;
    const double r = s.radius;
    half = {std::max(half.x, std::fabs(d.x) + r), std::max(half.y, std::fabs(d.y) + r),
            std::max(half.z, std::fabs(d.z) + r)};
    radius = std::max(radius, std::sqrt(dot(d, d)) + r);
  }
  void add(const Extent& other) {
    half = {std::max(half.x, other.half.x), std::max(half.y, other.half.y), std::max(half.z, other.half.z)};
    radius = std::max(radius, other.radius);
  }
};

void measure(const Measures& measures, const Sphere* spheres, std::size_t count, GridPlan& plan) {
  core::GridView& view = plan.view;
  const auto middle = [](double hi, double minus_lo) { return static_cast<float>((hi - minus_lo) / 2); };
  view.centre = {middle(measures.hi.x, measures.minus_lo.x), middle(measures.hi.y, measures.minus_lo.y),
                 middle(measures.hi.z, measures.minus_lo.z)};
  const Extent extent = sumOf(spheres, count, Extent{{view.centre.x, view.centre.y, view.centre.z}});
  view.half = {roundUp(extent.half.x), roundUp(extent.half.y), roundUp(extent.half.z)};
  view.count = static_cast<std::uint32_t>(count);
  view.radius = roundUp(extent.radius);
  view.largest = measures.largest;
  view.reach = roundUp(std::sqrt(measures.reach2) + view.largest);
  // Spheres so small that coordinates would need more bits than a key has count as of a coarser level.
  const float widest = std::max({view.half.x, view.half.y, view.half.z});
  plan.lowest_level =
      std::max(core::levelOf(measures.smallest), core::levelOf(widest) - (core::kAxisBits - 2));
  plan.levels = plan.levelAt(view.largest) + 1;
  const float cells = 2 * widest * core::powerOfTwo(-plan.lowest_level);
  plan.curve_bits = std::bit_width(static_cast<std::uint32_t>(cells) | 1u);
}

void countLevels(const Measures& measures, GridPlan& plan) {
  std::uint32_t counts[core::kMostLevels] = {};
  for (std::size_t i = 0; i < measures.levels.size(); ++i) {
    const int level = static_cast<int>(i) + Measures::kLowest - plan.lowest_level;
    if (measures.levels[i] > 0) counts[std::max(level, 0)] += measures.levels[i];
  }
  std::uint32_t before = 0;
  plan.view.cluster_count = 0;
  for (int level = 0; level < core::kMostLevels; ++level) {
    plan.level_first[level] = before;
    before += counts[level];
    plan.view.cluster_count += (counts[level] + core::kClusterSize - 1) / core::kClusterSize;
  }
  plan.level_first[core::kMostLevels] = before;
}

/// How many cells are within `reach` of a point, on average over its place in its cell; lengths in edges.
double cellsNear(double reach) {
  return 1 + reach * (6 + reach * (9.42 + reach * 4.19));
}

/// The finest grid level for which cells are not too many.
void chooseGridLevels(GridPlan& plan) {
  int grid_level = 1;  // above the lowest level
  for (; grid_level < plan.levels; ++grid_level) {
    double listed = 0;
    for (int level = 0; level < plan.levels; ++level) {
      // A level's radii are from 1/4 to 1/2 of its cells, and query spheres reach a quarter of the grid
      // level's.
      listed += (plan.level_first[level + 1] - plan.level_first[level]) *
                cellsNear(0.36 * std::ldexp(1.0, level - grid_level) + 0.25);
    }
    if (listed <= kListed * plan.view.count) break;
  }
  plan.view.finest = plan.lowest_level + grid_level;
  plan.view.grid_levels = plan.levels - grid_level + 1;
}

}  // namespace

float roundUp(double x) {
  return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

GridPlan planGrid(const Sphere* spheres, std::size_t count) {
  GridPlan plan{};
  const Measures measures = sumOf(spheres, count, Measures{});
  measure(measures, spheres, count, plan);
  countLevels(measures, plan);
  chooseGridLevels(plan);
  return plan;
}

}  // namespace innersphere
