// Which cells list the spheres of a cluster, found by a warp.
#pragma once

#include "cuda_build.hpp"
#include "cuda_device.hpp"

namespace innersphere::device {

/// A cluster for a warp, or a part of it.
struct ClusterJob {
  unsigned cluster, part, parts;
  std::uint32_t first, count;  ///< spheres
};

/// False if there is no such job.
inline __device__ bool clusterJob(const BuildPlan& plan, unsigned number, ClusterJob& job) {
  const Jobs& jobs = plan.jobs;
  int level = 0;
  while (level < plan.grid.levels && number >= jobs.first[level + 1]) ++level;
  if (level == plan.grid.levels) return false;
  job.parts = jobs.parts[level];
  const unsigned at = number - jobs.first[level], of_level = at / job.parts;
  job.part = at % job.parts;
  job.cluster = jobs.first_cluster[level] + of_level;
  job.first = plan.grid.level_first[level] + of_level * core::kClusterSize;
  job.count = min(core::kClusterSize, plan.grid.level_first[level + 1] - job.first);
  return true;
}

/// Calls f(tier, x, y, z, place) for each cell that lists one of the spheres of a job; `sphere` is the
/// lane's, relative to the centre. Lanes take spheres or, where these are in many cells, cells.
template <typename F>
__device__ void forCells(const Tiers& tiers, const ClusterJob& job, const Sphere& sphere, unsigned lane,
                         core::CellsNear (&shared)[kWarp], const F& f) {
  constexpr unsigned kFew = 32;
  const std::uint32_t place = job.first + lane;
  for (int t = 0; t < tiers.count; ++t) {
    const core::TierCells& tier = tiers.of[t];
    const bool listed = lane < job.count && place >= tier.first_place;
    if (!__any_sync(kAll, listed)) return;  // nor do later tiers list them
    core::CellsNear near{};
    std::uint64_t cells = 0;
    if (listed) {
      near = tier.near(sphere);
      cells = 1;
      for (int axis = 0; axis < 3; ++axis) cells *= near.hi[axis] - near.lo[axis] + 1;
    }
    if (__all_sync(kAll, cells <= kFew)) {
      if (!listed || job.part != 0) continue;
      for (std::uint32_t z = near.lo[2]; z <= near.hi[2]; ++z) {
        for (std::uint32_t y = near.lo[1]; y <= near.hi[1]; ++y) {
          for (std::uint32_t x = near.lo[0]; x <= near.hi[0]; ++x) {
            if (!near.isFar(x, y, z)) f(tier, tiers.first[t], x, y, z, place);
          }
        }
      }
      continue;
    }
    std::uint64_t begin = cells;
    for (unsigned step = 1; step < kWarp; step *= 2) {
      const std::uint64_t before = __shfl_up_sync(kAll, begin, step);
      if (lane >= step) begin += before;
    }
    const std::uint64_t total = __shfl_sync(kAll, begin, kWarp - 1);
    begin -= cells;
    __syncwarp();
    shared[lane] = near;
    __syncwarp();
    for (std::uint64_t all = std::uint64_t{job.part} * kWarp; all < total;
         all += std::uint64_t{job.parts} * kWarp) {
      const std::uint64_t at = all + lane;
      unsigned owner = 0;
      for (unsigned step = kWarp / 2; step > 0; step /= 2) {
        if (__shfl_sync(kAll, begin, owner + step) <= at) owner += step;
      }
      const std::uint64_t first = __shfl_sync(kAll, begin, owner);
      if (at >= total) continue;
      const core::CellsNear& of = shared[owner];
      std::uint64_t number = at - first;
      const std::uint32_t nx = of.hi[0] - of.lo[0] + 1, ny = of.hi[1] - of.lo[1] + 1;
      const auto x = of.lo[0] + static_cast<std::uint32_t>(number % nx);
      number /= nx;
      const auto y = of.lo[1] + static_cast<std::uint32_t>(number % ny);
      const auto z = of.lo[2] + static_cast<std::uint32_t>(number / ny);
      if (!of.isFar(x, y, z)) f(tier, tiers.first[t], x, y, z, job.first + owner);
    }
  }
}

}  // namespace innersphere::device
