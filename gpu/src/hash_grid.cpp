#include "hash_grid.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/hilbert.hpp"
#include "digit_sort.hpp"

namespace innersphere {

using core::Vec3f;

namespace {

constexpr double kListed = 8;  ///< cells of the finest tier that list a sphere, on average, at most

Vec3f relativeCentre(const Sphere& s, const Vec3f& centre) {
  return Vec3f{s.x, s.y, s.z} - centre;
}

core::Vec3r fromCentre(const Sphere& s, const Vec3f& centre) {
  return core::Vec3r{s.x, s.y, s.z} - core::Vec3r{centre.x, centre.y, centre.z};
}

double distance(const Sphere& s, const Vec3f& p) {
  const core::Vec3r d = fromCentre(s, p);
  return std::sqrt(dot(d, d));
}

/// A float that is not smaller.
float roundUp(double x) {
  return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

/// Calls f(begin, end) for ranges that cover [0, n), in several threads where that pays.
template <typename F>
void forRanges(std::size_t n, const F& f) {
  constexpr std::size_t kGrain = 4096;
  if (n <= kGrain) return f(std::size_t{0}, n);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, kGrain),
                    [&](const auto& range) { f(range.begin(), range.end()); });
}

/// How many cells are within `reach` of a point, on average over its place in its cell; lengths in edges.
double cellsNear(double reach) {
  return 1 + reach * (6 + reach * (9.42 + reach * 4.19));
}

}  // namespace

void HashGrid::build(const Sphere* spheres, std::size_t count, GridScratch& scratch) {
  measure(spheres, count);
  orderSpheres(spheres, scratch);
  makeClusters();
  scratch.lister.list(view_, scratch.first_places, lists_);
  view_.cells = lists_.table.data();
  view_.listed = lists_.listed.data();
  view_.listed_count = static_cast<std::uint32_t>(lists_.listed.size()) - CellLists::kPastEnd;
  view_.hash_shift = lists_.hash_shift;
  const std::lock_guard lock(device_copies_.mutex);
  device_copies_.copies.clear();
}

void HashGrid::measure(const Sphere* spheres, std::size_t count) {
  constexpr double kMax = std::numeric_limits<double>::infinity();
  double lo[3] = {kMax, kMax, kMax}, hi[3] = {-kMax, -kMax, -kMax};
  float smallest = std::numeric_limits<float>::max(), largest = 0;
  double reach2 = 0;
  for (const Sphere* sphere = spheres; sphere < spheres + count; ++sphere) {
    const Sphere& s = *sphere;
    const double c[3] = {s.x, s.y, s.z}, r = s.radius;
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis] = std::min(lo[axis], c[axis] - r);
      hi[axis] = std::max(hi[axis], c[axis] + r);
    }
    smallest = std::min(smallest, s.radius);
    largest = std::max(largest, s.radius);
    reach2 = std::max(reach2, c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
  }
  const auto middle = [&](int axis) { return static_cast<float>((lo[axis] + hi[axis]) / 2); };
  view_.centre = {middle(0), middle(1), middle(2)};
  // Measured from the rounded centre, so that nothing of a small sphere far from the origin is lost.
  double half[3] = {0, 0, 0}, radius = 0;
  for (const Sphere* sphere = spheres; sphere < spheres + count; ++sphere) {
    const Sphere& s = *sphere;
    const core::Vec3r d = fromCentre(s, view_.centre);
    const double r = s.radius;
    half[0] = std::max(half[0], std::fabs(d.x) + r);
    half[1] = std::max(half[1], std::fabs(d.y) + r);
    half[2] = std::max(half[2], std::fabs(d.z) + r);
    radius = std::max(radius, std::sqrt(dot(d, d)) + r);
  }
  view_.half = {roundUp(half[0]), roundUp(half[1]), roundUp(half[2])};
  view_.count = static_cast<std::uint32_t>(count);
  view_.radius = roundUp(radius);
  view_.reach = roundUp(std::sqrt(reach2) + largest);
  view_.largest = largest;
  // Spheres so small that coordinates would need more bits than a key has count as of a coarser level.
  const float widest = std::max({view_.half.x, view_.half.y, view_.half.z});
  lowest_level_ = std::max(core::levelOf(smallest), core::levelOf(widest) - (core::kAxisBits - 2));
}

void HashGrid::orderSpheres(const Sphere* spheres, GridScratch& scratch) {
  using Place = GridScratch::Place;
  const float inverse_cell = core::powerOfTwo(-lowest_level_);
  const Vec3f half = view_.half;
  const std::size_t count = view_.count;
  const auto cellsAlong = [&](float x) { return static_cast<std::uint32_t>(x * inverse_cell); };
  curve_bits_ = std::bit_width(cellsAlong(2 * std::max({half.x, half.y, half.z})) | 1u);
  std::vector<Place>& places = scratch.places;
  places.resize(count);
  scratch.spare.resize(count);
  forRanges(count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f p = relativeCentre(spheres[i], view_.centre) + half;
      const int level = std::max(core::levelOf(spheres[i].radius) - lowest_level_, 0);
      places[i] = {static_cast<std::uint64_t>(level) << (3 * curve_bits_) |
                       core::hilbertPlace(cellsAlong(p.x), cellsAlong(p.y), cellsAlong(p.z), curve_bits_),
                   static_cast<std::uint32_t>(i)};
    }
  });
  // Spheres of equal keys keep the order of the packing.
  const int levels = std::max(core::levelOf(view_.largest) - lowest_level_, 0) + 1;
  level_first_.assign(static_cast<std::size_t>(levels), 0);
  sortByBits(
      places, scratch.spare, [](const Place& place) { return place.key; }, 0,
      3 * curve_bits_ + std::bit_width(static_cast<unsigned>(levels - 1)));
  spheres_.resize(count);
  centred_.resize(count + 1);
  constexpr float kFar = std::numeric_limits<float>::infinity();
  centred_.back() = {kFar, kFar, kFar, -kFar};
  ids_.resize(count);
  places_.resize(count);
  forRanges(count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Sphere& s = spheres[places[k].index];
      const Vec3f p = relativeCentre(s, view_.centre);
      spheres_[k] = s;
      centred_[k] = {p.x, p.y, p.z, s.radius};
      ids_[k] = places[k].index;
      places_[places[k].index] = static_cast<std::uint32_t>(k);
    }
  });
  view_.spheres = spheres_.data();
  view_.centred = centred_.data();
  view_.ids = ids_.data();
  chooseTiers(scratch);
}

/// Finds where each level begins, and the finest tier for which cells are not too many.
void HashGrid::chooseTiers(GridScratch& scratch) {
  const std::vector<GridScratch::Place>& places = scratch.places;
  const auto begins = [&](std::size_t level) {
    return std::partition_point(places.begin(), places.end(), [&](const GridScratch::Place& place) {
      return place.key >> (3 * curve_bits_) < level;
    });
  };
  for (std::size_t l = 0; l < level_first_.size(); ++l)
    level_first_[l] = static_cast<std::uint32_t>(begins(l) - places.begin());
  const int levels = static_cast<int>(level_first_.size());
  int tier = 1;  // above the lowest level
  for (; tier < levels; ++tier) {
    double listed = 0;
    for (int l = 0; l < levels; ++l) {
      const std::uint32_t end = l + 1 < levels ? level_first_[static_cast<std::size_t>(l) + 1] : view_.count;
      // A level's radii are from 1/4 to 1/2 of its cells, and walkers reach a quarter of the tier's.
      listed += (end - level_first_[static_cast<std::size_t>(l)]) *
                cellsNear(0.36 * std::ldexp(1.0, l - tier) + 0.25);
    }
    if (listed <= kListed * view_.count) break;
  }
  view_.finest = lowest_level_ + tier;
  view_.tiers = levels - tier + 1;
  scratch.first_places.assign(1, 0);
  for (int t = 1; t < view_.tiers; ++t)  // levels below the tier's look elsewhere
    scratch.first_places.push_back(level_first_[static_cast<std::size_t>(tier + t - 1)]);
}

void HashGrid::makeClusters() {
  clusters_.clear();
  for (std::size_t l = 0; l < level_first_.size(); ++l) {
    const std::uint32_t end = l + 1 < level_first_.size() ? level_first_[l + 1] : view_.count;
    for (std::uint32_t k = level_first_[l]; k < end; k += core::kClusterSize)
      clusters_.push_back({{}, k, std::min(core::kClusterSize, end - k)});
  }
  forRanges(clusters_.size(), [&](std::size_t from, std::size_t to) {
    for (std::size_t c = from; c < to; ++c) {
      core::Cluster& cluster = clusters_[c];
      const Sphere* begin = spheres_.data() + cluster.first;
      const Sphere* end = begin + cluster.count;
      constexpr float kMax = std::numeric_limits<float>::max();
      Vec3f lo{kMax, kMax, kMax}, hi{-kMax, -kMax, -kMax};
      for (const Sphere* s = begin; s < end; ++s) {
        lo = {std::min(lo.x, s->x), std::min(lo.y, s->y), std::min(lo.z, s->z)};
        hi = {std::max(hi.x, s->x), std::max(hi.y, s->y), std::max(hi.z, s->z)};
      }
      const Vec3f middle = 0.5f * (lo + hi);
      double radius = 0;
      for (const Sphere* s = begin; s < end; ++s) radius = std::max(radius, distance(*s, middle) + s->radius);
      cluster.ball = {middle.x, middle.y, middle.z, roundUp(radius)};
    }
  });
  cluster_tree_.build(clusters_);
  view_.clusters = clusters_.data();
  view_.cluster_count = static_cast<std::uint32_t>(clusters_.size());
  occupancy_.build(view_);
}

}  // namespace innersphere
