// Finds those clusters of a batch that can meet the other body: bounds of groups come first, then those of
// clusters.
#pragma once

#include "cuda/warp.hpp"

namespace innersphere::device {

constexpr unsigned kCullWarps = 4;  ///< in a block

/// A block takes a query, a warp up to kWarp groups of one of its bodies: a lane tests a group, then all test
/// the clusters of each group that passed.
__global__ void __launch_bounds__(kCullWarps* kWarp) cullClusters(const __grid_constant__ Batch batch) {
  constexpr unsigned kWarpClusters = kWarp * kGroup;
  const unsigned lane = threadIdx.x % kWarp, number = blockIdx.x;
  const Query& query = batch.queries[number];
  unsigned warp = blockIdx.y * kCullWarps + threadIdx.x / kWarp;
  if (warp == 0) {
    for (unsigned i = lane; i < kSumWords; i += kWarp)
      reinterpret_cast<unsigned long long*>(batch.sums + number)[i] = 0;
  }
  const unsigned warps_a = (query.clusters[0] + kWarpClusters - 1) / kWarpClusters;
  const unsigned side = warp < warps_a ? 0 : 1;
  if (side != 0) warp -= warps_a;
  const unsigned clusters = query.clusters[side], first = warp * kWarpClusters;
  if (first >= clusters) return;
  const Grid& own = *query.grids[side];
  const core::GridView& grid = query.grids[1 - side]->view;
  const core::Search& search = query.searches[side];

  const unsigned group = first / kGroup + lane;
  const bool active = group * kGroup < clusters && ballMeets(grid, search, load(own.groups + group));
  unsigned mask = 0;  // of the clusters of this lane's group
  for (unsigned left = __ballot_sync(kAll, active); left != 0; left &= left - 1) {
    const unsigned from = static_cast<unsigned>(__ffs(static_cast<int>(left)) - 1);
    const unsigned cluster = first + from * kGroup + lane;
    const bool meets = cluster < clusters && ballMeets(grid, search, load(&own.view.clusters[cluster].ball));
    const unsigned meeting = __ballot_sync(kAll, meets);
    if (lane == from) mask = meeting;
  }
  unsigned tasks = 0;
  for (unsigned k = 0; k < kGroup; k += kTaskClusters)
    tasks += (mask >> k & ((1u << kTaskClusters) - 1)) != 0;
  const unsigned before = scan(tasks);
  unsigned at = 0;
  if (lane == kWarp - 1 && before > 0) at = atomicAdd(&batch.counters->tasks, before);
  at = __shfl_sync(kAll, at, kWarp - 1) + before - tasks;
  for (unsigned k = 0; k < kGroup; k += kTaskClusters) {
    const unsigned some = mask >> k & ((1u << kTaskClusters) - 1);
    if (some != 0) batch.tasks[at++] = packTask({number, side, first + lane * kGroup + k, some});
  }
}

}  // namespace innersphere::device
