// Holds what a batch and a single query share: how a warp traverses clusters and decides what it finds.
#pragma once

#include "cuda/sums.hpp"

namespace innersphere::device {

/// Returns the one of three functions that is for a goal.
template <typename Launch>
Launch forGoal(Goal goal, Launch touch, Launch volume, Launch wrench) {
  return goal == Goal::touch ? touch : goal == Goal::volume ? volume : wrench;
}

struct WarpMemory {
  union {
    ListTraversals traversals;  ///< while candidates are found
    Columns columns;            ///< while they are decided
  };
  Sums sums;
  Queue queue;
};

/// What a warp holds while it works on one query.
template <Goal goal>
struct Warp {
  __device__ Warp(WarpMemory& m, unsigned l) : memory(m), lane(l), summer(l, m.sums) {}

  WarpMemory& memory;
  unsigned lane;
  unsigned queued = 0;
  bool touched = false;  ///< Goal::touch: there is a pair
  Summer<goal> summer;

  __device__ void flush(DeviceSums& sums, const core::Units& units) {
    summer.flush(sums, units, lane, memory.sums);
    queued = 0;
    touched = false;
  }
};

/// A cluster to traverse, or a slice of its tests: the iterations `slice`, slice + slices, ...
struct ClusterSlice {
  unsigned side, cluster, slice, slices;
};

/// How far the traversal of a slice has come.
struct Progress {
  std::uint32_t number = 0;  ///< of the query spheres' cells
  unsigned iteration = 0;    ///< of the slice in these cells
};

/// Queues a cluster's candidates. True at its end; false if the queue is full first. All lanes call it.
template <Goal goal>
__device__ __forceinline__ bool findCandidates(const Scene& scene, const ClusterSlice& slice,
                                               Progress& progress, Warp<goal>& warp) {
  const unsigned lane = warp.lane;
  const Grid &own = scene.grids[slice.side], &grid = scene.grids[1 - slice.side];
  const uint2 run = __ldg(reinterpret_cast<const uint2*>(&own.view.clusters[slice.cluster].first));
  bool more = true;
  for (; more; ++progress.number, progress.iteration = 0) {
    core::Lookup lookup{};
    List list{};
    const core::Traversal traversal{own.view, grid.view, scene.query.searches[slice.side]};
    std::uint32_t count = 0;
    if (lane < run.y && core::makeLookup(traversal, load(own.view.spheres + run.x + lane), lookup))
      list = listOf(grid.view, lookup, progress.number, count);
    more = __any_sync(kAll, progress.number + 1 < count);
    const unsigned self = (run.x + lane) | (slice.side == 0 ? kFromA : 0);
    const Lists lists = lineUp(lookup, list, self, lane, warp.memory.traversals);
    while (true) {
      const unsigned first = (progress.iteration * slice.slices + slice.slice) * kWarp;
      if (first >= lists.total) break;
      if (!testStep(grid, lists, progress.number, first, lane, warp.memory.traversals, warp.memory.queue,
                    warp.queued))
        return false;
      ++progress.iteration;
    }
  }
  progress = {};
  return true;
}

/// Decides all candidates that wait, or only as many as fill the warp. All lanes call it.
template <Goal goal>
__device__ __forceinline__ void decide(const Batch& batch, const Scene& scene, unsigned query, bool all,
                                       DeviceSums& sums, Warp<goal>& warp) {
  WarpMemory& memory = warp.memory;
  __syncwarp();
  while (warp.queued >= kWarp || (all && warp.queued > 0)) {
    const unsigned count = min(warp.queued, kWarp);
    warp.queued -= count;
    const bool any =
        warp.summer.add(batch, scene, query, memory.queue[warp.queued + min(warp.lane, count - 1)],
                        warp.lane < count, warp.lane, memory.columns, memory.sums);
    if (goal == Goal::touch && any) {
      warp.touched = true;
      return;
    }
    if (warp.summer.full()) warp.summer.flush(sums, scene.query.units, warp.lane, memory.sums);
  }
}

inline __device__ bool isTouched(const DeviceSums& sums) {
  return *const_cast<const volatile unsigned long long*>(&sums.pairs) != 0;
}

/// Copies the query and its grids, with so many threads.
__device__ __forceinline__ void copyScene(const Query& query, unsigned thread, unsigned threads,
                                          Scene& scene) {
  const auto copy = [&](const auto& from, auto& to) {
    constexpr unsigned kWords = sizeof from / sizeof(uint2);
    for (unsigned i = thread; i < kWords; i += threads)
      reinterpret_cast<uint2*>(&to)[i] = reinterpret_cast<const uint2*>(&from)[i];
  };
  copy(*query.grids[0], scene.grids[0]);
  copy(*query.grids[1], scene.grids[1]);
  copy(query, scene.query);
}

/// True in the last block to come here, for all its threads.
inline __device__ bool isLastBlock(Counters& counters) {
  __shared__ bool last;
  __syncthreads();
  if (threadIdx.x == 0) {
    __threadfence();
    last = atomicAdd(&counters.blocks, 1u) == gridDim.x - 1;
    __threadfence();
  }
  __syncthreads();
  return last;
}

}  // namespace innersphere::device
