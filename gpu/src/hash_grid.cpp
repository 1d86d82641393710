#include "hash_grid.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace innersphere {

using core::CellBox;
using core::Vec3f;

namespace {

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

/// Cells of the finest level that a ball about one of the grid's own spheres touches.
CellBox boxOf(const core::GridView& grid, const Sphere& s, float radius) {
  CellBox box{};
  [[maybe_unused]] const bool inside = core::cellBox(grid, relativeCentre(s, grid.centre), radius, box);
  assert(inside);
  return box;
}

/// Cells of one sphere on its level. Rounding can make its box a hair longer than the cell, never by more
/// than what queries add to theirs, so the second cell along an axis may be taken for the last.
struct SphereCells {
  int level;
  std::uint32_t lo[3];
  std::uint32_t size[3];
  std::uint32_t count() const { return size[0] * size[1] * size[2]; }
};

SphereCells cellsOf(const core::GridView& grid, const Sphere& s, float growth) {
  const float radius = s.radius + growth;
  const CellBox box = boxOf(grid, s, radius);
  SphereCells cells;
  cells.level = std::max(core::levelOf(radius) - grid.finest, 0);
  for (int axis = 0; axis < 3; ++axis) {
    cells.lo[axis] = box.lo[axis] >> cells.level;
    cells.size[axis] = box.hi[axis] >> cells.level > cells.lo[axis] ? 2 : 1;
  }
  return cells;
}

/// Sorts by cell: blocks in the order of their keys, in each its cells.
std::uint64_t sortKey(int level, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  const std::uint64_t block =
      core::blockKey(level, x >> core::kBlockBits, y >> core::kBlockBits, z >> core::kBlockBits);
  return block << (3 * core::kBlockBits) | static_cast<std::uint64_t>(core::bitOfCell(x, y, z));
}

/// Every third bit of a number of kAxisBits bits.
std::uint64_t spreadBits(std::uint64_t x) {
  std::uint64_t spread = 0;
  for (int bit = 0; bit < core::kAxisBits; ++bit) spread |= (x >> bit & 1) << (3 * bit);
  return spread;
}

}  // namespace

HashGrid::HashGrid(std::vector<Sphere> spheres, float growth) : spheres_(std::move(spheres)) {
  measure(growth);
  orderSpheres();
  boundClusters();
  fillCells(growth);
}

void HashGrid::measure(float growth) {
  constexpr double kMax = std::numeric_limits<double>::infinity();
  double lo[3] = {kMax, kMax, kMax}, hi[3] = {-kMax, -kMax, -kMax};
  float smallest = std::numeric_limits<float>::max(), largest = 0;
  double reach = 0;
  for (const Sphere& s : spheres_) {
    const double c[3] = {s.x, s.y, s.z}, r = static_cast<double>(s.radius) + growth;
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis] = std::min(lo[axis], c[axis] - r);
      hi[axis] = std::max(hi[axis], c[axis] + r);
    }
    smallest = std::min(smallest, s.radius);
    largest = std::max(largest, s.radius);
    reach = std::max(reach, distance(s, {0, 0, 0}) + s.radius);
  }
  const auto middle = [&](int axis) { return static_cast<float>((lo[axis] + hi[axis]) / 2); };
  view_.centre = {middle(0), middle(1), middle(2)};
  // Measured from the rounded centre, so that nothing of a small sphere far from the origin is lost.
  double half[3] = {0, 0, 0}, radius = 0;
  for (const Sphere& s : spheres_) {
    const core::Vec3r d = fromCentre(s, view_.centre);
    const double r = static_cast<double>(s.radius) + growth;
    half[0] = std::max(half[0], std::fabs(d.x) + r);
    half[1] = std::max(half[1], std::fabs(d.y) + r);
    half[2] = std::max(half[2], std::fabs(d.z) + r);
    radius = std::max(radius, std::sqrt(dot(d, d)) + r);
  }
  view_.half = {roundUp(half[0]), roundUp(half[1]), roundUp(half[2])};
  view_.count = static_cast<std::uint32_t>(spheres_.size());
  view_.radius = roundUp(radius);
  view_.reach = roundUp(reach);
  view_.largest = largest;
  // Spheres so small that cell coordinates would need more bits than a key has share a coarser level.
  const float sizes[3] = {view_.half.x, view_.half.y, view_.half.z};
  const float widest = *std::max_element(sizes, sizes + 3);
  view_.finest = std::max(core::levelOf(smallest + growth), core::levelOf(widest) - (core::kAxisBits - 1));
  view_.coarsest = std::max(core::levelOf(largest + growth), view_.finest);
  view_.inverse_cell = std::ldexp(1.0f, -view_.finest);
  for (int axis = 0; axis < 3; ++axis)
    view_.last_cell[axis] = std::floor(2 * sizes[axis] * view_.inverse_cell);
}

void HashGrid::orderSpheres() {
  struct Place {
    std::uint64_t code;
    std::uint32_t level;
    std::uint32_t index;
  };
  std::vector<Place> places(spheres_.size());
  tbb::parallel_for(std::size_t{0}, spheres_.size(), [&](std::size_t i) {
    const CellBox box = boxOf(view_, spheres_[i], 0);
    places[i] = {spreadBits(box.lo[0]) | spreadBits(box.lo[1]) << 1 | spreadBits(box.lo[2]) << 2,
                 static_cast<std::uint32_t>(std::max(core::levelOf(spheres_[i].radius) - view_.finest, 0)),
                 static_cast<std::uint32_t>(i)};
  });
  tbb::parallel_sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    if (a.level != b.level) return a.level < b.level;
    return a.code != b.code ? a.code < b.code : a.index < b.index;
  });
  std::vector<Sphere> sorted(places.size());
  ids_.resize(places.size());
  places_.resize(places.size());
  for (std::size_t k = 0; k < places.size(); ++k) {
    sorted[k] = spheres_[places[k].index];
    ids_[k] = places[k].index;
    places_[places[k].index] = static_cast<std::uint32_t>(k);
  }
  spheres_ = std::move(sorted);
  view_.spheres = spheres_.data();
  view_.ids = ids_.data();
}

void HashGrid::boundClusters() {
  const std::size_t n = spheres_.size();
  clusters_.resize((n + core::kClusterSize - 1) / core::kClusterSize);
  tbb::parallel_for(std::size_t{0}, clusters_.size(), [&](std::size_t c) {
    const std::size_t begin = c * core::kClusterSize,
                      end = std::min<std::size_t>(begin + core::kClusterSize, n);
    constexpr float kMax = std::numeric_limits<float>::max();
    Vec3f lo{kMax, kMax, kMax}, hi{-kMax, -kMax, -kMax};
    for (std::size_t k = begin; k < end; ++k) {
      const Sphere& s = spheres_[k];
      lo = {std::min(lo.x, s.x), std::min(lo.y, s.y), std::min(lo.z, s.z)};
      hi = {std::max(hi.x, s.x), std::max(hi.y, s.y), std::max(hi.z, s.z)};
    }
    const Vec3f middle = 0.5f * (lo + hi);
    double radius = 0;
    for (std::size_t k = begin; k < end; ++k) {
      const Sphere& s = spheres_[k];
      radius = std::max(radius, distance(s, middle) + s.radius);
    }
    clusters_[c] = {middle.x, middle.y, middle.z, roundUp(radius)};
  });
  view_.clusters = clusters_.data();
  view_.cluster_count = static_cast<std::uint32_t>(clusters_.size());
}

void HashGrid::fillCells(float growth) {
  const std::size_t n = spheres_.size();
  std::vector<std::uint32_t> first(n + 1, 0);
  tbb::parallel_for(std::size_t{0}, n,
                    [&](std::size_t i) { first[i + 1] = cellsOf(view_, spheres_[i], growth).count(); });
  for (std::size_t i = 0; i < n; ++i) first[i + 1] += first[i];

  struct Entry {
    std::uint64_t key;
    std::uint32_t entry;
  };
  std::vector<Entry> all(first[n]);
  tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) {
    const SphereCells cells = cellsOf(view_, spheres_[i], growth);
    std::uint32_t at = first[i];
    for (std::uint32_t z = 0; z < cells.size[2]; ++z) {
      for (std::uint32_t y = 0; y < cells.size[1]; ++y) {
        for (std::uint32_t x = 0; x < cells.size[0]; ++x) {
          const std::uint32_t begins = (x == 0 ? 1u : 0u) | (y == 0 ? 2u : 0u) | (z == 0 ? 4u : 0u);
          all[at++] = {sortKey(cells.level, cells.lo[0] + x, cells.lo[1] + y, cells.lo[2] + z),
                       begins << core::kIndexBits | static_cast<std::uint32_t>(i)};
        }
      }
    }
  });
  constexpr std::uint32_t kIndexMask = (1u << core::kIndexBits) - 1;
  tbb::parallel_sort(all.begin(), all.end(), [](const Entry& a, const Entry& b) {
    return a.key != b.key ? a.key < b.key : (a.entry & kIndexMask) < (b.entry & kIndexMask);
  });

  entries_.resize(all.size());
  std::vector<std::uint64_t> keys;
  for (std::size_t k = 0; k < all.size(); ++k) {
    entries_[k] = all[k].entry;
    if (k > 0 && all[k].key == all[k - 1].key) continue;
    keys.push_back(all[k].key);
    cells_.push_back(static_cast<std::uint32_t>(k));
  }
  cells_.push_back(static_cast<std::uint32_t>(all.size()));
  view_.cells = cells_.data();
  view_.entries = entries_.data();
  fillTable(keys);
}

/// `keys`: the sort keys of the occupied cells, rising.
void HashGrid::fillTable(const std::vector<std::uint64_t>& keys) {
  constexpr int kCellBits = 3 * core::kBlockBits;
  std::vector<core::Block> blocks;
  for (std::size_t cell = 0; cell < keys.size(); ++cell) {
    const std::uint64_t key = keys[cell] >> kCellBits;
    if (blocks.empty() || blocks.back().key != key)
      blocks.push_back({key, 0, static_cast<std::uint32_t>(cell)});
    blocks.back().occupied |= std::uint64_t{1} << (keys[cell] & ((1u << kCellBits) - 1));
  }
  int bits = 1;
  while ((std::size_t{1} << bits) < 2 * blocks.size()) ++bits;
  blocks_.assign(std::size_t{1} << bits, core::Block{0, 0, 0});
  view_.hash_shift = 64 - bits;
  const std::size_t mask = blocks_.size() - 1;
  for (const core::Block& block : blocks) {
    std::size_t at = core::hashBlock(view_, block.key);
    while (blocks_[at].occupied != 0) at = (at + 1) & mask;
    blocks_[at] = block;
  }
  view_.blocks = blocks_.data();
}

}  // namespace innersphere
