#include "grid_plan.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace innersphere {

using core::GridPlan;
using core::Vec3f;
using core::Vec3r;

namespace {

constexpr double kListed = 8;  ///< cells of the finest tier that list a sphere, on average, at most
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Maxima over all spheres, which may be taken in any order.
template <std::size_t kValues>
struct Maxima {
  std::array<double, kValues> of;
  Maxima() { of.fill(-kInfinity); }
  void add(std::size_t i, double x) { of[i] = std::max(of[i], x); }
};

/// Calls f(sphere, maxima) for each.
template <std::size_t kValues, typename F>
Maxima<kValues> maximaOf(const Sphere* spheres, std::size_t count, const F& f) {
  constexpr std::size_t kGrain = 4096;
  using Range = tbb::blocked_range<const Sphere*>;
  const auto of = [&](const Range& range, Maxima<kValues> maxima) {
    for (const Sphere& s : range) f(s, maxima);
    return maxima;
  };
  const Range all(spheres, spheres + count, kGrain);
  if (count <= kGrain) return of(all, {});
  return tbb::parallel_reduce(all, Maxima<kValues>{}, of, [](Maxima<kValues> a, const Maxima<kValues>& b) {
    for (std::size_t i = 0; i < kValues; ++i) a.add(i, b.of[i]);
    return a;
  });
}

void measure(const Sphere* spheres, std::size_t count, GridPlan& plan) {
  enum { kUpper = 0, kLower = 3, kLargest = 6, kSmallest = 7, kReach2 = 8, kBounds = 9 };
  const Maxima<kBounds> bounds = maximaOf<kBounds>(spheres, count, [](const Sphere& s, auto& maxima) {
    const double c[3] = {s.x, s.y, s.z}, r = s.radius;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      maxima.add(kUpper + axis, c[axis] + r);
      maxima.add(kLower + axis, r - c[axis]);
    }
    maxima.add(kLargest, r);
    maxima.add(kSmallest, -r);
    maxima.add(kReach2, c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
  });
  core::GridView& view = plan.view;
  const auto middle = [&](std::size_t axis) {
    return static_cast<float>((bounds.of[kUpper + axis] - bounds.of[kLower + axis]) / 2);
  };
  view.centre = {middle(0), middle(1), middle(2)};
  // Measured from the rounded centre, so that nothing of a small sphere far from the origin is lost.
  const Vec3r centre{view.centre.x, view.centre.y, view.centre.z};
  const Maxima<4> sizes = maximaOf<4>(spheres, count, [&](const Sphere& s, auto& maxima) {
    const Vec3r d = Vec3r{s.x, s.y, s.z} - centre;
    const double r = s.radius;
    maxima.add(0, std::fabs(d.x) + r);
    maxima.add(1, std::fabs(d.y) + r);
    maxima.add(2, std::fabs(d.z) + r);
    maxima.add(3, std::sqrt(dot(d, d)) + r);
  });
  view.half = {roundUp(sizes.of[0]), roundUp(sizes.of[1]), roundUp(sizes.of[2])};
  view.count = static_cast<std::uint32_t>(count);
  view.radius = roundUp(sizes.of[3]);
  view.largest = static_cast<float>(bounds.of[kLargest]);
  view.reach = roundUp(std::sqrt(bounds.of[kReach2]) + view.largest);
  const float widest = std::max({view.half.x, view.half.y, view.half.z});
  plan.lowest_level = std::max(core::levelOf(static_cast<float>(-bounds.of[kSmallest])),
                               core::levelOf(widest) - (core::kAxisBits - 2));
  plan.levels = plan.levelAt(view.largest) + 1;
  const float cells = 2 * widest * core::powerOfTwo(-plan.lowest_level);
  plan.curve_bits = std::bit_width(static_cast<std::uint32_t>(cells) | 1u);
}

void countLevels(const Sphere* spheres, std::size_t count, GridPlan& plan) {
  std::uint32_t counts[core::kMostLevels] = {};
  for (std::size_t i = 0; i < count; ++i) ++counts[plan.levelAt(spheres[i].radius)];
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

/// The finest tier for which cells are not too many.
void chooseTiers(GridPlan& plan) {
  int tier = 1;  // above the lowest level
  for (; tier < plan.levels; ++tier) {
    double listed = 0;
    for (int level = 0; level < plan.levels; ++level) {
      // A level's radii are from 1/4 to 1/2 of its cells, and walkers reach a quarter of the tier's.
      listed += (plan.level_first[level + 1] - plan.level_first[level]) *
                cellsNear(0.36 * std::ldexp(1.0, level - tier) + 0.25);
    }
    if (listed <= kListed * plan.view.count) break;
  }
  plan.view.finest = plan.lowest_level + tier;
  plan.view.tiers = plan.levels - tier + 1;
}

}  // namespace

float roundUp(double x) {
  return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

GridPlan planGrid(const Sphere* spheres, std::size_t count) {
  GridPlan plan{};
  measure(spheres, count, plan);
  countLevels(spheres, count, plan);
  chooseTiers(plan);
  return plan;
}

}  // namespace innersphere
