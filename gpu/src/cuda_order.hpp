// The first steps of a build: spheres come into their order, and clusters are made of them. Each function is
// a step that all threads of a launch do together.
#pragma once

#include "cuda_cells.hpp"

namespace innersphere::device {

/// All threads of a launch.
struct Threads {
  std::uint64_t first, count;

  template <typename F>
  __device__ void each(std::uint64_t items, const F& f) const {
    for (std::uint64_t i = first; i < items; i += count) f(i);
  }
  /// For warps. f gets a number and the lane.
  template <typename F>
  __device__ void eachWarp(std::uint64_t items, const F& f) const {
    for (std::uint64_t i = first / kWarp; i < items; i += count / kWarp)
      f(i, static_cast<unsigned>(first % kWarp));
  }
};

/// What the steps work on.
struct BuildArrays {
  const Sphere* given;
  std::uint64_t* keys;
  std::uint32_t* numbers;  ///< of spheres in their buckets
  std::uint64_t* bucket_keys;
  std::uint32_t* ids;     ///< in the order of bucket_keys
  std::uint32_t* sorted;  ///< ids in the order of the grid
  std::uint32_t* bucket_counts;
  std::uint32_t* bucket_starts;
  std::uint32_t* cell_counts;
  std::uint64_t* cell_sums;  ///< see packed()
  std::uint64_t* block_sums;
  unsigned* longest;  ///< list
  BuildStatus* to_host;
};

/// Each sphere's key, and its number in its bucket. Clears the table.
inline __device__ void makeKeys(const BuildPlan& plan, const GridArrays& grid, const BuildArrays& arrays,
                                const core::HilbertTable& table, const Threads& threads) {
  threads.each(grid.table_room, [&](std::uint64_t at) { grid.cells[at] = {~std::uint64_t{0}, 0, 0}; });
  threads.each(plan.grid.view.count, [&](std::uint64_t i) {
    const std::uint64_t key = plan.grid.keyOf(load(arrays.given + i), table);
    arrays.keys[i] = key;
    arrays.numbers[i] = atomicAdd(arrays.bucket_counts + (key >> plan.bucket_shift), 1u);
  });
}

inline __device__ void fillBuckets(const BuildPlan& plan, const BuildArrays& arrays, const Threads& threads) {
  threads.each(plan.grid.view.count, [&](std::uint64_t i) {
    const std::uint64_t key = arrays.keys[i];
    const std::uint32_t at = arrays.bucket_starts[key >> plan.bucket_shift] + arrays.numbers[i];
    arrays.bucket_keys[at] = key;
    arrays.ids[at] = static_cast<std::uint32_t>(i);
  });
}

/// Each sphere goes to its place in its bucket: by its key, then by its index.
inline __device__ void orderBuckets(const BuildPlan& plan, const BuildArrays& arrays,
                                    const Threads& threads) {
  threads.each(plan.grid.view.count, [&](std::uint64_t at) {
    const std::uint64_t key = arrays.bucket_keys[at], bucket = key >> plan.bucket_shift;
    const std::uint32_t id = arrays.ids[at];
    const std::uint32_t first = arrays.bucket_starts[bucket], end = arrays.bucket_starts[bucket + 1];
    std::uint32_t place = first;
    for (std::uint32_t other = first; other < end; ++other) {
      const std::uint64_t other_key = arrays.bucket_keys[other];
      const bool before = other_key == key ? arrays.ids[other] < id : other_key < key;
      place += before ? 1 : 0;
    }
    arrays.sorted[place] = id;
  });
}

/// A ball about the middle of the centres of some spheres, around all of them: a lane has one each, which is
/// not `valid` in those beyond.
inline __device__ Sphere ballAround(const Sphere& s, bool valid) {
  constexpr float kMax = 3.402823466e+38f;
  const auto upper = [&](float x) { return maximum(valid ? x : -kMax); };
  const core::Vec3f lo{-upper(-s.x), -upper(-s.y), -upper(-s.z)}, hi{upper(s.x), upper(s.y), upper(s.z)};
  const core::Vec3f middle = core::middleOf(lo, hi);
  const core::Vec3r d = core::Vec3r{s.x, s.y, s.z} - core::Vec3r{middle.x, middle.y, middle.z};
  const double radius = maximum(valid ? sqrt(dot(d, d)) + s.radius : 0.0);
  return {middle.x, middle.y, middle.z, nextafterf(static_cast<float>(radius), INFINITY)};
}

/// Spheres and clusters; with `count`, also what each cell will list.
inline __device__ void orderSpheres(const BuildPlan& plan, const GridArrays& grid, const BuildArrays& arrays,
                                    bool count, core::CellsNear (&shared)[kWarp], const Threads& threads) {
  threads.eachWarp(plan.jobs.all, [&](std::uint64_t number, unsigned lane) {
    const ClusterJob job = clusterJob(plan, static_cast<unsigned>(number));
    const bool valid = lane < job.count;
    const std::uint32_t place = job.first + lane, id = valid ? arrays.sorted[place] : 0;
    const Sphere s = valid ? load(arrays.given + id) : Sphere{};
    if (job.part == 0 && job.tier == 0) {
      if (valid) {
        grid.spheres[place] = s;
        grid.ids[place] = id;
        grid.places[id] = place;
      }
      const Sphere ball = ballAround(s, valid);
      if (lane == 0) grid.clusters[job.cluster] = {ball, job.first, job.count};
    }
    if (!count) return;
    std::uint32_t* const counts = arrays.cell_counts + plan.tiers.first[job.tier];
    forCells<std::uint32_t>(plan.tiers, job, plan.grid.centred(s), lane, shared,
                            [&](const std::uint32_t(&cells)[kTogether], unsigned mask, std::uint32_t) {
#pragma unroll
                              for (unsigned k = 0; k < kTogether; ++k) {
                                if ((mask >> k & 1) != 0) atomicAdd(counts + cells[k], 1u);
                              }
                            });
  });
}

}  // namespace innersphere::device
