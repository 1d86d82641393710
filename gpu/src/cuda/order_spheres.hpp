// Does the first steps of a build: spheres come into their order, and clusters are made of them. Each
// function is a step that all threads of a launch do together.
#pragma once

#include "cuda/cells.hpp"

namespace innersphere::device {

/// Describes all threads of a launch.
struct Threads {
  std::uint64_t first, count;

  template <typename F>
  __device__ void each(std::uint64_t items, const F& f) const {
    for (std::uint64_t i = first; i < items; i += count) f(i);
  }
  /// Returns the same threads with the last warp first.
  __device__ Threads reversed() const {
    return {count - kWarp - first / kWarp * kWarp + first % kWarp, count};
  }

  __device__ unsigned lane() const { return static_cast<unsigned>(first % kWarp); }

  /// Calls f(item, lane) with a warp for each item.
  template <typename F>
  __device__ void eachWarp(std::uint64_t items, const F& f) const {
    for (std::uint64_t i = first / kWarp; i < items; i += count / kWarp) f(i, lane());
  }
};

/// Holds what the steps work on.
struct BuildArrays {
  const Sphere* given;
  std::uint64_t* keys;
  std::uint32_t* numbers;  ///< of spheres in their buckets
  std::uint64_t* bucket_keys;
  std::uint32_t* ids;         ///< in the order of bucket_keys
  std::uint32_t* in_buckets;  ///< spheres
  std::uint32_t* bucket_starts;
  std::uint32_t* cell_counts;
  std::uint64_t* cell_sums;  ///< see packed()
  core::Cell* used;          ///< cells with a list, by their numbers
  std::uint64_t* block_sums;
  unsigned* longest;  ///< list
  BuildStatus* to_host;
};

inline __device__ std::uint32_t bucketOf(const BuildPlan& plan, std::uint64_t key) {
  const int bits = 3 * plan.grid.curve_bits, level = static_cast<int>(key >> bits);
  const std::uint64_t place = key & ((std::uint64_t{1} << bits) - 1);
  return plan.buckets.first[level] + static_cast<std::uint32_t>(place >> plan.buckets.shift[level]);
}

/// Finds each sphere's key, and its number in its bucket.
inline __device__ void makeKeys(const BuildPlan& plan, const BuildArrays& arrays,
                                const core::HilbertTable& table, const Threads& threads) {
  threads.each(plan.grid.view.count, [&](std::uint64_t i) {
    const std::uint64_t key = plan.grid.keyOf(load(arrays.given + i), table);
    arrays.keys[i] = key;
    arrays.numbers[i] = atomicAdd(arrays.in_buckets + bucketOf(plan, key), 1u);
  });
}

/// Brings spheres into their buckets, and clears what later steps, and the next build, find empty.
inline __device__ void fillBuckets(const BuildPlan& plan, const GridArrays& grid, const BuildArrays& arrays,
                                   std::uint64_t cells, const Threads& threads) {
  threads.each(plan.grid.view.count, [&](std::uint64_t i) {
    const std::uint64_t key = arrays.keys[i];
    const std::uint32_t at = arrays.bucket_starts[bucketOf(plan, key)] + arrays.numbers[i];
    arrays.bucket_keys[at] = key;
    arrays.ids[at] = static_cast<std::uint32_t>(i);
  });
  threads.each(plan.buckets.all, [&](std::uint64_t bucket) { arrays.in_buckets[bucket] = 0; });
  threads.each(cells + 1, [&](std::uint64_t cell) { arrays.cell_counts[cell] = 0; });
  threads.each(grid.table_room, [&](std::uint64_t at) { grid.cells[at] = {~std::uint64_t{0}, 0, 0}; });
  if (threads.first == 0) *arrays.longest = 0;
}

/// Brings each sphere to its place: by its key, then by its index.
inline __device__ void orderBuckets(const BuildPlan& plan, const GridArrays& grid, const BuildArrays& arrays,
                                    const Threads& threads) {
  threads.each(plan.grid.view.count, [&](std::uint64_t at) {
    const std::uint64_t key = arrays.bucket_keys[at];
    const std::uint32_t bucket = bucketOf(plan, key), id = arrays.ids[at];
    const Sphere s = load(arrays.given + id);
    const std::uint32_t first = arrays.bucket_starts[bucket], end = arrays.bucket_starts[bucket + 1];
    std::uint32_t place = first;
    for (std::uint32_t other = first; other < end; ++other) {
      const std::uint64_t other_key = arrays.bucket_keys[other];
      const bool before = other_key == key ? arrays.ids[other] < id : other_key < key;
      place += before ? 1 : 0;
    }
    grid.spheres[place] = s;
    grid.ids[place] = id;
    grid.places[id] = place;
  });
}

/// Returns a ball about the middle of the centres of some spheres, around all of them: a lane has one each,
/// which is not `valid` in those beyond.
inline __device__ Sphere ballAround(const Sphere& s, bool valid) {
  constexpr float kMax = 3.402823466e+38f;
  const auto upper = [&](float x) { return maximum(valid ? x : -kMax); };
  const Vec3f lo{-upper(-s.x), -upper(-s.y), -upper(-s.z)}, hi{upper(s.x), upper(s.y), upper(s.z)};
  const Vec3f middle = core::middleOf(lo, hi);
  const Vec3d d = Vec3d{s.x, s.y, s.z} - Vec3d{middle.x, middle.y, middle.z};
  const double radius = maximum(valid ? sqrt(dot(d, d)) + s.radius : 0.0);
  return {middle.x, middle.y, middle.z, nextafterf(static_cast<float>(radius), INFINITY)};
}

/// Counts that these cells list a sphere. Neighbours are in the same cells, so a warp adds up first, and the
/// first lane that comes to a cell adds for all.
inline __device__ void countCells(const SomeCells<std::uint32_t>& some, bool together, std::uint32_t* counts,
                                  WarpCells& shared) {
  if (!together) return forSome(some, [&](unsigned k) { atomicAdd(counts + some.cells[k], 1u); });
  unsigned before[kTogether];
  forSome(some, [&](unsigned k) { before[k] = atomicAdd(shared.counts + some.in_box[k], 1u); });
  __syncwarp();
  forSome(some, [&](unsigned k) {
    if (before[k] != 0) return;
    std::uint32_t& count = shared.counts[some.in_box[k]];
    atomicAdd(counts + some.cells[k], count);
    count = 0;
  });
  __syncwarp();
}

/// Makes the clusters; with `count`, also counts what each cell will list.
inline __device__ void makeClusters(const BuildPlan& plan, const GridArrays& grid, const BuildArrays& arrays,
                                    bool count, WarpCells& shared, const Threads& threads) {
  shared.clear(threads.lane());
  threads.eachWarp(plan.list_tasks.all, [&](std::uint64_t number, unsigned lane) {
    const ListTask task = listTask(plan, static_cast<unsigned>(number));
    const bool valid = lane < task.count;
    const Sphere s = valid ? loadNew(grid.spheres + task.first + lane) : Sphere{};
    if (task.slice == 0 && task.grid_level == 0) {
      const Sphere ball = ballAround(s, valid);
      if (lane == 0) grid.clusters[task.cluster] = {ball, task.first, task.count};
    }
    if (!count) return;
    std::uint32_t* const counts = arrays.cell_counts + plan.grid_levels.first[task.grid_level];
    forCells<std::uint32_t>(plan.grid_levels, task, plan.grid.centred(s), lane, shared.near,
                            [&](const SomeCells<std::uint32_t>& some, bool together) {
                              countCells(some, together, counts, shared);
                            });
  });
}

}  // namespace innersphere::device
