// Of the clusters of a batch, those that can meet the other body: bounds of groups first, then of clusters.
#pragma once

#include "cuda/warp.hpp"

namespace innersphere::device {

constexpr unsigned kCullWarps = 4;  ///< in a block

/// A block takes a query, a warp up to kWarp groups of one of its bodies: a lane tests a group, then all test
/// the clusters of each group that passed.
__global__ void __launch_bounds__(kCullWarps* kWarp) cullClusters(const __grid_constant__ Batch batch) {
  constexpr unsigned kTask = kWarp * kGroup;  // clusters
  const unsigned lane = threadIdx.x % kWarp, number = blockIdx.x;
  const Query& query = batch.queries[number];
  unsigned task = blockIdx.y * kCullWarps + threadIdx.x / kWarp;
  if (task == 0) {
    for (unsigned i = lane; i < kSumWords; i += kWarp)
      reinterpret_cast<unsigned long long*>(batch.sums + number)[i] = 0;
  }
  const unsigned tasks_a = (query.clusters[0] + kTask - 1) / kTask;
  const unsigned side = task < tasks_a ? 0 : 1;
  if (side != 0) task -= tasks_a;
  const unsigned clusters = query.clusters[side], first = task * kTask;
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
  unsigned items = 0;
  for (unsigned k = 0; k < kGroup; k += kItem) items += (mask >> k & ((1u << kItem) - 1)) != 0;
  const unsigned before = scan(items, lane);
  unsigned at = 0;
  if (lane == kWarp - 1 && before > 0) at = atomicAdd(&batch.counters->items, before);
  at = __shfl_sync(kAll, at, kWarp - 1) + before - items;
  for (unsigned k = 0; k < kGroup; k += kItem) {
    const unsigned some = mask >> k & ((1u << kItem) - 1);
    if (some != 0) batch.items[at++] = packItem({number, side, first + lane * kGroup + k, some});
  }
}

}  // namespace innersphere::device
