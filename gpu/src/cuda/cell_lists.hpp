// Holds what both ways to make lists share: the hash table, and all that follows it.
#pragma once

#include "cuda/build_grid.hpp"
#include "cuda/half_spheres.hpp"
#include "cuda/warp.hpp"

namespace innersphere::device {

constexpr unsigned kListThreads = 256;
constexpr unsigned long long kNoKey = ~0ull;

/// One number holds how many cells have a list and, in so many low bits, how many places the lists take; so
/// both are summed at once.
constexpr int kPlaceBits = 36;
inline __host__ __device__ std::uint64_t packed(std::uint32_t count) {
  return count == 0 ? 0 : std::uint64_t{1} << kPlaceBits | core::padded(count);
}
inline __host__ __device__ std::uint64_t placesOf(std::uint64_t packed) {
  return packed & ((std::uint64_t{1} << kPlaceBits) - 1);
}

struct Packed {
  __host__ __device__ std::uint64_t operator()(std::uint32_t count) const { return packed(count); }
};

/// Describes the cells as a build has them. `sums` are those of packed(counts) before each cell, and after
/// the last.
struct CellCounts {
  const std::uint32_t* counts;
  std::uint64_t* sums;
  std::uint64_t cells;

  __device__ BuildStatus status(unsigned longest) const {
    const std::uint64_t all = sums[cells];
    return {all >> kPlaceBits, placesOf(all), longest};
  }
};

inline __device__ std::uint64_t keyOf(const GridLevels& grid_levels, std::uint64_t cell) {
  int t = 0;
  while (cell >= grid_levels.first[t + 1]) ++t;
  return grid_levels.of[t].keyOf(static_cast<std::uint32_t>(cell - grid_levels.first[t]));
}

/// Has a counter for each cell of all grid levels. While the lists are filled, the sums of cells move on.
struct DenseCells : CellCounts {
  const core::Cell* used;  ///< those with a list, by rising key

  __device__ core::Cell find(const GridLevels& grid_levels, std::uint64_t key) const {
    constexpr std::uint64_t kMask = (1u << core::kAxisBits) - 1;
    const auto axis = [&](int number) {
      return static_cast<std::uint32_t>(key >> number * core::kAxisBits & kMask);
    };
    const int t = static_cast<int>(key >> (3 * core::kAxisBits));
    const std::uint64_t cell = grid_levels.first[t] + grid_levels.of[t].cellAt(axis(0), axis(1), axis(2));
    const std::uint32_t count = counts[cell];
    return {key, static_cast<std::uint32_t>(placesOf(sums[cell])) - count, count};
  }
};

/// Has only cells with a list, by rising key.
struct SortedCells : CellCounts {
  const std::uint64_t* keys;

  __device__ core::Cell find(const GridLevels&, std::uint64_t key) const {
    std::uint64_t lo = 0;
    for (std::uint64_t hi = cells; lo + 1 < hi;) {
      const std::uint64_t middle = lo + (hi - lo) / 2;
      (keys[middle] <= key ? lo : hi) = middle;
    }
    return {key, static_cast<std::uint32_t>(placesOf(sums[lo])), counts[lo]};
  }
};

inline __device__ int hashShift(std::uint64_t cells) {
  return 64 - (63 - __clzll(static_cast<long long>(tableSizeFor(cells))));
}

/// Puts one of so many cells into the table. With linear probing, a smaller key goes first and a larger one
/// moves on: whoever comes when, the table is the same.
inline __device__ void insertCell(const GridArrays& arrays, std::uint64_t cells, unsigned long long key) {
  core::GridView view{};
  view.hash_shift = hashShift(cells);
  const std::uint64_t mask = tableSizeFor(cells) - 1;
  for (std::uint64_t at = core::hashCell(view, key);; at = (at + 1) & mask) {
    const unsigned long long there =
        atomicMin(reinterpret_cast<unsigned long long*>(&arrays.cells[at].key), key);
    if (there == kNoKey) return;
    key = max(key, there);
  }
}

inline __device__ CellFrame frameOf(const core::GridView& grid, std::uint64_t key) {
  constexpr std::uint64_t kMask = (1u << core::kAxisBits) - 1;
  const auto axis = [&](int number) { return static_cast<float>(key >> number * core::kAxisBits & kMask); };
  return frameOf(grid, static_cast<int>(key >> (3 * core::kAxisBits)), {axis(0), axis(1), axis(2)});
}

/// Returns two places of a list.
inline __device__ EntryPair entriesOf(const core::GridPlan& plan, const GridArrays& arrays,
                                      const CellFrame& frame, const uint2& places) {
  const auto ball = [&](std::uint32_t place) {
    return place < plan.view.count
               ? partnerBall(plan.view, frame, plan.centred(loadNew(arrays.spheres + place)))
               : noBall();
  };
  return pairOf(ball(places.x), ball(places.y));
}

/// Puts a ball around the balls of a group of clusters; a warp calls it.
inline __device__ void fillGroup(const GridArrays& arrays, std::uint32_t clusters, std::uint64_t group,
                                 unsigned lane) {
  static_assert(kGroup == kWarp, "a lane takes a cluster");
  constexpr float kMax = 3.402823466e+38f;
  const std::uint64_t cluster = group * kGroup + lane;
  const bool valid = cluster < clusters;
  const Sphere s = valid ? arrays.clusters[cluster].ball : Sphere{};
  const auto upper = [&](float x) { return maximum(valid ? x + s.radius : -kMax); };
  const Vec3f lo{-upper(-s.x), -upper(-s.y), -upper(-s.z)}, hi{upper(s.x), upper(s.y), upper(s.z)};
  const Vec3f middle = core::middleOf(lo, hi);
  const Vec3d d = Vec3d{s.x, s.y, s.z} - Vec3d{middle.x, middle.y, middle.z};
  const double radius = maximum(valid ? sqrt(dot(d, d)) + s.radius : 0.0);
  if (lane == 0) arrays.groups[group] = {middle.x, middle.y, middle.z, __double2float_ru(radius)};
}

/// Fills entry `i` of those that follow the lists in Grid::entries.
inline __device__ void fillEntryOfAll(const core::GridPlan& grid, const GridArrays& arrays,
                                      std::uint64_t listed, std::uint64_t i) {
  const auto first = static_cast<std::uint32_t>(2 * i);
  arrays.entries[listed / 2 + i] = entriesOf(grid, arrays, frameOfAll(grid.view), {first, first + 1});
}

/// Fills the cells of the table, and the header, with all threads of a launch.
template <typename Cells>
__device__ void finishGrid(const BuildPlan& plan, const GridArrays& arrays, const Cells& cells,
                           const BuildStatus& status, std::uint64_t thread, std::uint64_t threads) {
  for (std::uint64_t i = thread; i < tableSizeFor(status.cells); i += threads) {
    const std::uint64_t key = arrays.cells[i].key;
    arrays.cells[i] = key == kNoKey ? core::Cell{0, 0, 0} : cells.find(plan.grid_levels, key);
  }
  if (thread != 0) return;
  core::GridView view = plan.grid.view;
  view.spheres = arrays.spheres;
  view.ids = arrays.ids;
  view.clusters = arrays.clusters;
  view.cells = arrays.cells;
  view.listed = arrays.listed;
  view.listed_count = static_cast<std::uint32_t>(status.listed);
  view.hash_shift = hashShift(status.cells);
  *arrays.header = {view, arrays.entries, arrays.groups, arrays.places};
}

}  // namespace innersphere::device
