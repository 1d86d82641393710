#include "hash_grid.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/hilbert.hpp"
#include "digit_sort.hpp"

namespace innersphere {

using core::CellBox;
using core::Vec3f;

namespace {

constexpr float kClusterCells = 8;        ///< of its level, that a cluster may extend over along each axis
constexpr std::uint32_t kBlockFill = 10;  ///< spheres that an occupied block should hold, at least

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

/// The cell of the finest level that holds the centre.
std::array<std::uint32_t, 3> cellOf(const core::GridView& grid, const Sphere& s) {
  const Vec3f p = relativeCentre(s, grid.centre);
  CellBox box{};
  [[maybe_unused]] const bool inside = core::cellBox(grid, p, p, box);
  assert(inside);
  return {box.lo[0], box.lo[1], box.lo[2]};
}

}  // namespace

/// A sphere's key in the order of the grid: its level, then its place on the curve.
struct HashGrid::Place {
  std::uint64_t key;
  std::uint32_t index;
};

HashGrid::HashGrid(std::vector<Sphere> spheres) : spheres_(std::move(spheres)) {
  measure();
  orderSpheres();
  makeClusters();
  makeColumns();
  fillTable();
}

void HashGrid::measure() {
  constexpr double kMax = std::numeric_limits<double>::infinity();
  double lo[3] = {kMax, kMax, kMax}, hi[3] = {-kMax, -kMax, -kMax};
  float smallest = std::numeric_limits<float>::max(), largest = 0;
  double reach2 = 0;
  for (const Sphere& s : spheres_) {
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
  for (const Sphere& s : spheres_) {
    const core::Vec3r d = fromCentre(s, view_.centre);
    const double r = s.radius;
    half[0] = std::max(half[0], std::fabs(d.x) + r);
    half[1] = std::max(half[1], std::fabs(d.y) + r);
    half[2] = std::max(half[2], std::fabs(d.z) + r);
    radius = std::max(radius, std::sqrt(dot(d, d)) + r);
  }
  view_.half = {roundUp(half[0]), roundUp(half[1]), roundUp(half[2])};
  view_.count = static_cast<std::uint32_t>(spheres_.size());
  view_.radius = roundUp(radius);
  view_.reach = roundUp(std::sqrt(reach2) + largest);
  view_.largest = largest;
  // Spheres so small that cell coordinates would need more bits than a key has share a coarser level.
  const float sizes[3] = {view_.half.x, view_.half.y, view_.half.z};
  const float widest = *std::max_element(sizes, sizes + 3);
  view_.finest = std::max(core::levelOf(smallest), core::levelOf(widest) - (core::kAxisBits - 1));
  view_.level_count = std::max(core::levelOf(largest) - view_.finest, 0) + 1;
  view_.inverse_cell = std::ldexp(1.0f, -view_.finest);
  for (int axis = 0; axis < 3; ++axis)
    view_.last_cell[axis] = std::floor(2 * sizes[axis] * view_.inverse_cell);
}

void HashGrid::orderSpheres() {
  const float* last = view_.last_cell;
  curve_bits_ = std::bit_width(static_cast<std::uint32_t>(std::max({last[0], last[1], last[2], 1.0f})));
  std::vector<Place> places(spheres_.size()), spare(spheres_.size());
  forRanges(spheres_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto cell = cellOf(view_, spheres_[i]);
      const int level = std::max(core::levelOf(spheres_[i].radius) - view_.finest, 0);
      places[i] = {static_cast<std::uint64_t>(level) << (3 * curve_bits_) |
                       core::hilbertPlace(cell[0], cell[1], cell[2], curve_bits_),
                   static_cast<std::uint32_t>(i)};
    }
  });
  // Spheres of equal keys keep the order of the packing.
  const int level_bits = std::bit_width(static_cast<unsigned>(view_.level_count - 1));
  sortByBits(
      places, spare, [](const Place& place) { return place.key; }, 0, 3 * curve_bits_ + level_bits);
  std::vector<Sphere> sorted(places.size());
  ids_.resize(places.size());
  places_.resize(places.size());
  forRanges(places.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      sorted[k] = spheres_[places[k].index];
      ids_[k] = places[k].index;
      places_[places[k].index] = static_cast<std::uint32_t>(k);
    }
  });
  spheres_ = std::move(sorted);
  view_.spheres = spheres_.data();
  view_.ids = ids_.data();
  splitLevels(places);
}

/// Finds where each level begins, and the smallest blocks that hold kBlockFill spheres on average.
void HashGrid::splitLevels(const std::vector<Place>& places) {
  levels_.assign(static_cast<std::size_t>(view_.level_count), core::Level{});
  // Two neighbours share a block if their keys differ only in the bits below it.
  const auto levelOf = [&](const Place& place) {
    return static_cast<std::size_t>(place.key >> (3 * curve_bits_));
  };
  using Steps = std::array<std::uint32_t, core::kAxisBits + 1>;
  std::vector<Steps> steps(levels_.size(), Steps{});
  for (std::size_t k = 0; k < places.size(); ++k) {
    core::Level& level = levels_[levelOf(places[k])];
    if (level.count++ == 0) {
      level.first = static_cast<std::uint32_t>(k);
    } else {
      const int differ = std::bit_width(places[k].key ^ places[k - 1].key);
      ++steps[levelOf(places[k])][static_cast<std::size_t>((differ + 2) / 3)];
    }
    level.largest = std::max(level.largest, spheres_[k].radius);
  }
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    core::Level& level = levels_[l];
    if (level.count == 0) continue;
    level.blocks = 1;
    int shift = curve_bits_;
    // Never below the level's own cells, so that the blocks near a sphere stay few.
    for (; shift > static_cast<int>(l); --shift) {
      const std::uint32_t blocks = level.blocks + steps[l][static_cast<std::size_t>(shift)];
      if (std::uint64_t{blocks} * kBlockFill > level.count) break;
      level.blocks = blocks;
    }
    level.block_shift = shift;
  }
  view_.levels = levels_.data();
}

/// Cuts each level's run where a cluster is full, or would become wider than kClusterCells: the partners of
/// few spheres that are far apart would be all there are.
void HashGrid::makeClusters() {
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    const core::Level& level = levels_[l];
    const float widest = kClusterCells * std::ldexp(1.0f, view_.finest + static_cast<int>(l));
    Vec3f lo{}, hi{};
    core::Cluster cluster{};
    for (std::uint32_t k = level.first; k < level.first + level.count; ++k) {
      const Sphere& s = spheres_[k];
      lo = {std::min(lo.x, s.x), std::min(lo.y, s.y), std::min(lo.z, s.z)};
      hi = {std::max(hi.x, s.x), std::max(hi.y, s.y), std::max(hi.z, s.z)};
      const Vec3f size = hi - lo;
      const bool fits = std::max({size.x, size.y, size.z}) <= widest && cluster.count < core::kClusterSize;
      if (cluster.count > 0 && fits) {
        ++cluster.count;
        continue;
      }
      if (cluster.count > 0) clusters_.push_back(cluster);
      cluster.first = k;
      cluster.count = 1;
      lo = hi = {s.x, s.y, s.z};
    }
    if (cluster.count > 0) clusters_.push_back(cluster);
  }
  forRanges(clusters_.size(), [&](std::size_t from, std::size_t to) {
    for (std::size_t c = from; c < to; ++c) {
      core::Cluster& cluster = clusters_[c];
      const Sphere* begin = spheres_.data() + cluster.first;
      const Sphere* end = begin + cluster.count;
      constexpr float kMax = std::numeric_limits<float>::max();
      Vec3f lo{kMax, kMax, kMax}, hi{-kMax, -kMax, -kMax};
      cluster.smallest = kMax;
      for (const Sphere* s = begin; s < end; ++s) {
        lo = {std::min(lo.x, s->x), std::min(lo.y, s->y), std::min(lo.z, s->z)};
        hi = {std::max(hi.x, s->x), std::max(hi.y, s->y), std::max(hi.z, s->z)};
        cluster.smallest = std::min(cluster.smallest, s->radius);
      }
      const Vec3f middle = 0.5f * (lo + hi);
      double radius = 0;
      for (const Sphere* s = begin; s < end; ++s) radius = std::max(radius, distance(*s, middle) + s->radius);
      cluster.ball = {middle.x, middle.y, middle.z, roundUp(radius)};
    }
  });
  view_.clusters = clusters_.data();
  view_.cluster_count = static_cast<std::uint32_t>(clusters_.size());
}

void HashGrid::makeColumns() {
  const std::size_t n = spheres_.size(), stride = n + Columns::kPadding;
  coordinates_.assign(4 * stride, 0.0f);
  float* x = coordinates_.data();
  forRanges(n, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Vec3f p = relativeCentre(spheres_[k], view_.centre);
      x[k] = p.x;
      x[stride + k] = p.y;
      x[2 * stride + k] = p.z;
      x[3 * stride + k] = spheres_[k].radius;
    }
  });
  columns_ = {x, x + stride, x + 2 * stride, x + 3 * stride};
}

void HashGrid::fillTable() {
  std::size_t blocks = 0;
  for (const core::Level& level : levels_) blocks += level.blocks;
  const int bits = std::max(1, static_cast<int>(std::bit_width(2 * blocks - 1)));
  table_.assign(std::size_t{1} << bits, core::Block{});
  view_.hash_shift = 64 - bits;
  const std::size_t mask = table_.size() - 1;
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    const core::Level& level = levels_[l];
    core::Block block{};
    const auto finish = [&] {
      if (block.count == 0) return;
      std::size_t at = core::hashBlock(view_, block.key);
      while (table_[at].count != 0) at = (at + 1) & mask;
      table_[at] = block;
    };
    for (std::uint32_t k = level.first; k < level.first + level.count; ++k) {
      const auto cell = cellOf(view_, spheres_[k]);
      const std::uint64_t key = core::blockKey(static_cast<int>(l), cell[0] >> level.block_shift,
                                               cell[1] >> level.block_shift, cell[2] >> level.block_shift);
      if (block.count == 0 || key != block.key) {
        finish();
        block = {key, k, 0};
      }
      ++block.count;
    }
    finish();
  }
  view_.blocks = table_.data();
}

}  // namespace innersphere
