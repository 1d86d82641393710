// Which cells list the spheres of a cluster, found by a warp.
#pragma once

#include "cuda/build_grid.hpp"
#include "cuda/warp.hpp"

namespace innersphere::device {

/// A cluster and a tier for a warp, or a part of these.
struct ClusterJob {
  unsigned cluster, part, parts;
  int tier;
  std::uint32_t first, count;  ///< spheres
};

inline __device__ ClusterJob clusterJob(const BuildPlan& plan, unsigned number) {
  const Jobs& jobs = plan.jobs;
  ClusterJob job;
  int level = plan.grid.levels - 1;
  while (number >= jobs.end[level]) --level;
  const unsigned at = number - (level + 1 < plan.grid.levels ? jobs.end[level + 1] : 0);
  const unsigned of_level = at / jobs.of_cluster[level];
  job.cluster = jobs.first_cluster[level] + of_level;
  job.first = plan.grid.level_first[level] + of_level * core::kClusterSize;
  job.count = min(core::kClusterSize, plan.grid.level_first[level + 1] - job.first);
  job.part = at % jobs.of_cluster[level];
  for (job.tier = 0;; ++job.tier) {
    job.parts = jobs.parts(level, plan.grid.levelsAbove(level, job.tier));
    if (job.part < job.parts) return job;
    job.part -= job.parts;
  }
}

constexpr unsigned kTogether = 8;  ///< cells that a lane looks at together
constexpr unsigned kBoxCells = 512;

/// What a warp shares while it looks at cells.
struct WarpCells {
  core::CellsNear near[kWarp];
  std::uint32_t counts[kBoxCells];  ///< of the cells of a box; zero between uses

  __device__ void clear(unsigned lane) {
    for (unsigned i = lane; i < kBoxCells; i += kWarp) counts[i] = 0;
    __syncwarp();
  }
};

/// Some cells near one sphere.
template <typename Cell>
struct SomeCells {
  Cell cells[kTogether];
  std::uint32_t in_box[kTogether];  ///< their numbers there; see CellBoxOfWarp
  unsigned mask;                    ///< a bit for each that lists the sphere
  std::uint32_t place;              ///< of the sphere
};

/// The cells near all spheres of a warp.
struct CellBoxOfWarp {
  int lo[3], size[3];
  bool fits;  ///< has no more than kBoxCells

  /// All lanes call it.
  __device__ CellBoxOfWarp(const core::CellsNear& near, bool valid) {
    constexpr int kNone = -(1 << 30);
    float cells = 1;
#pragma unroll
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis] = -maximum(valid ? -static_cast<int>(near.lo[axis]) : kNone);
      size[axis] = maximum(valid ? static_cast<int>(near.hi[axis]) : kNone) - lo[axis] + 1;
      cells *= static_cast<float>(size[axis]);
    }
    fits = cells <= kBoxCells;
  }
};

/// Those from number `from` on.
template <typename Cell>
__device__ __forceinline__ void lookAt(const core::TierCells& tier, const core::CellsNear& near,
                                       const CellBoxOfWarp& box, unsigned from, SomeCells<Cell>& some) {
  const std::uint32_t nx = near.hi[0] - near.lo[0] + 1, ny = near.hi[1] - near.lo[1] + 1, row = from / nx;
  std::uint32_t x = near.lo[0] + from % nx, y = near.lo[1] + row % ny, z = near.lo[2] + row / ny;
  some.mask = 0;
#pragma unroll
  for (unsigned k = 0; k < kTogether; ++k) {
    some.cells[k] = (static_cast<Cell>(z) * tier.size[1] + y) * tier.size[0] + x;
    some.in_box[k] = ((z - box.lo[2]) * box.size[1] + y - box.lo[1]) * box.size[0] + x - box.lo[0];
    if (z <= near.hi[2] && !near.isFar(x, y, z)) some.mask |= 1u << k;
    const bool next_row = ++x > near.hi[0];
    x = next_row ? near.lo[0] : x;
    y += next_row ? 1 : 0;
    const bool next_layer = y > near.hi[1];
    y = next_layer ? near.lo[1] : y;
    z += next_layer ? 1 : 0;
  }
}

/// Calls f(some, whether the box of all of them fits) for all cells of the job's tier that list one of its
/// spheres, kTogether at a time; all lanes call f together. `sphere` is the lane's, relative to the centre.
/// Lanes share all cells, as some spheres are in many.
template <typename Cell, typename F>
__device__ void forCells(const Tiers& tiers, const ClusterJob& job, const Sphere& sphere, unsigned lane,
                         core::CellsNear (&shared)[kWarp], const F& f) {
  const core::TierCells& tier = tiers.of[job.tier];
  unsigned calls = 0;
  core::CellsNear near{};
  __syncwarp();
  if (lane < job.count && job.first + lane >= tier.first_place) {
    near = tier.near(sphere);
    unsigned cells = 1;
    for (int axis = 0; axis < 3; ++axis) cells *= near.hi[axis] - near.lo[axis] + 1;
    calls = (cells + kTogether - 1) / kTogether;
    shared[lane] = near;
  }
  const CellBoxOfWarp box(near, calls > 0);
  const unsigned scanned = scan(calls, lane), begin = scanned - calls;
  const unsigned total = __shfl_sync(kAll, scanned, kWarp - 1);
  __syncwarp();
  for (unsigned all = job.part * kWarp; all < total; all += job.parts * kWarp) {
    const unsigned at = all + lane;
    unsigned owner = 0;
#pragma unroll
    for (unsigned step = kWarp / 2; step > 0; step /= 2) {
      if (__shfl_sync(kAll, begin, owner + step) <= at) owner += step;
    }
    const unsigned first = __shfl_sync(kAll, begin, owner);
    SomeCells<Cell> some;
    some.place = job.first + owner;
    if (at < total) {
      lookAt(tier, shared[owner], box, kTogether * (at - first), some);
    } else {
      some.mask = 0;
    }
    f(some, box.fits);
  }
}

/// Calls f(k) for those cells that count.
template <typename Cell, typename F>
__device__ __forceinline__ void forSome(const SomeCells<Cell>& some, const F& f) {
#pragma unroll
  for (unsigned k = 0; k < kTogether; ++k) {
    if ((some.mask >> k & 1) != 0) f(k);
  }
}

}  // namespace innersphere::device
