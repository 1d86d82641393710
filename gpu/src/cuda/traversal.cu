// The kernels of a query: all pairs of a batch, or a single one in one launch.
#include "cuda/cull.hpp"
#include "cuda/kernels.hpp"
#include "cuda/memory.hpp"
#include "cuda/sums.hpp"

namespace innersphere::device {

namespace {

constexpr unsigned kSingleWarps = 8;   ///< in a block
constexpr unsigned kSingleBlocks = 2;  ///< on each multiprocessor, as many as registers allow
constexpr unsigned kBatchWarps = 4;
constexpr unsigned kBatchBlocks = 7;
static_assert(kSingleWarps <= kMostWarps && kBatchWarps <= kMostWarps);

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

__device__ bool isTouched(const DeviceSums& sums) {
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
__device__ bool isLastBlock(const Batch& batch) {
  __shared__ bool last;
  __syncthreads();
  if (threadIdx.x == 0) {
    __threadfence();
    last = atomicAdd(&batch.counters->blocks, 1u) == gridDim.x - 1;
    __threadfence();
  }
  __syncthreads();
  return last;
}

/// The number of slices of each cluster. Where a block has few clusters, all its warps should get something.
__device__ unsigned slicesOf(unsigned clusters) {
  return clusters <= kSingleWarps / 4 ? 4 : clusters <= kSingleWarps / 2 ? 2 : 1;
}

/// The number of the bit, of those that are set in a row of words, that has `before` others before it.
__device__ unsigned bitOf(const unsigned (&words)[kSingleWarps], unsigned before) {
  unsigned word = 0;
  for (; before >= __popc(words[word]); ++word) before -= __popc(words[word]);
  unsigned bits = words[word];
  for (; before > 0; --before) bits &= bits - 1;
  return word * kWarp + static_cast<unsigned>(__ffs(static_cast<int>(bits)) - 1);
}

/// Decides what the warps of a block have queued, each 32 of all of it at a time. All threads call it.
template <Goal goal>
__device__ __forceinline__ void decideTogether(const Batch& batch, const Scene& scene,
                                               WarpMemory (&memory)[kSingleWarps],
                                               unsigned (&queued)[kSingleWarps], Warp<goal>& warp) {
  const unsigned number = threadIdx.x / kWarp;
  if (warp.lane == 0) queued[number] = warp.queued;
  warp.queued = 0;
  __syncthreads();
  unsigned all = 0;
  for (const unsigned of_warp : queued) all += of_warp;
  for (unsigned first = number * kWarp; first < all; first += kSingleWarps * kWarp) {
    unsigned at = min(first + warp.lane, all - 1), owner = 0;
    for (; at >= queued[owner]; ++owner) at -= queued[owner];
    WarpMemory& own = warp.memory;
    warp.summer.add(batch, scene, 0, memory[owner].queue[at], first + warp.lane < all, warp.lane, own.columns,
                    own.sums);
    if (warp.summer.full()) warp.summer.flush(*batch.sums, scene.query.units, warp.lane, own.sums);
  }
}

/// A single query: blocks share all its clusters, the warps of a block those that can meet the other body,
/// and the last block brings the sums home.
template <Goal goal>
__global__ void __launch_bounds__(kSingleWarps* kWarp, kSingleBlocks)
    traverseSingle(const __grid_constant__ Batch batch, const __grid_constant__ Query query) {
  constexpr unsigned kThreads = kSingleWarps * kWarp;
  __shared__ WarpMemory memory[kSingleWarps];
  __shared__ Scene scene;
  __shared__ unsigned active[kSingleWarps];  // a bit for each thread whose cluster is
  __shared__ unsigned queued[kSingleWarps];
  copyScene(query, threadIdx.x, kThreads, scene);
  Warp<goal> warp(memory[threadIdx.x / kWarp], threadIdx.x % kWarp);
  __syncthreads();

  const unsigned clusters_a = scene.query.clusters[0], clusters = clusters_a + scene.query.clusters[1];
  for (unsigned first = blockIdx.x; first < clusters; first += gridDim.x * kThreads) {
    const unsigned cluster = first + threadIdx.x * gridDim.x;
    bool meets = false;
    if (cluster < clusters) {
      const unsigned side = cluster < clusters_a ? 0 : 1;
      const core::Cluster* of_body = scene.grids[side].view.clusters;
      meets = ballMeets(scene.grids[1 - side].view, scene.query.searches[side],
                        load(&of_body[side == 0 ? cluster : cluster - clusters_a].ball));
    }
    const unsigned meeting = __ballot_sync(kAll, meets);
    if (warp.lane == 0) active[threadIdx.x / kWarp] = meeting;
    __syncthreads();
    unsigned active_count = 0;
    for (const unsigned of_warp : active) active_count += __popc(of_warp);
    const unsigned slices = slicesOf(active_count), all_slices = slices * active_count;
    for (unsigned number = threadIdx.x / kWarp; number < all_slices; number += kSingleWarps) {
      ClusterSlice slice{0, first + bitOf(active, number / slices) * gridDim.x, number % slices, slices};
      slice.side = slice.cluster < clusters_a ? 0 : 1;
      if (slice.side != 0) slice.cluster -= clusters_a;
      Progress progress;
      bool done;
      do {
        done = findCandidates(scene, slice, progress, warp);
        if (!done || goal == Goal::touch) decide(batch, scene, 0, done, *batch.sums, warp);
      } while (!done && !warp.touched);
      if (goal == Goal::touch && warp.touched) warp.flush(*batch.sums, scene.query.units);  // for all to see
      if (goal == Goal::touch && isTouched(*batch.sums)) break;
    }
    decideTogether(batch, scene, memory, queued, warp);
  }
  warp.summer.flushBlock(*batch.sums, scene.query.units, kSingleWarps, warp.lane,
                         [&](unsigned w) -> Sums& { return memory[w].sums; });
  if (!isLastBlock(batch)) return;
  if (threadIdx.x <= kResultWords) {
    const unsigned long long word = threadIdx.x < kResultWords
                                        ? resultOf<goal>(*batch.sums, scene.query.units, threadIdx.x)
                                        : __ldcg(&batch.counters->found);
    const unsigned long long run = static_cast<unsigned long long>(batch.run) << 32;
    auto* to = reinterpret_cast<ulonglong2*>(batch.signal->halves) + threadIdx.x;
    *to = {run | (word & 0xffffffffu), run | word >> 32};
  }
  __syncthreads();
  if (threadIdx.x < kSumWords) reinterpret_cast<unsigned long long*>(batch.sums)[threadIdx.x] = 0;
  if (threadIdx.x == 0) *batch.counters = {};
}

/// A power of two: few enough that all warps end at about the same time.
__device__ unsigned tasksAtOnce(unsigned tasks_of_warp) {
  constexpr unsigned kTakes = 8, kMost = 8;
  unsigned at_once = 1;
  while (at_once < kMost && 2 * at_once * kTakes <= tasks_of_warp) at_once *= 2;
  return at_once;
}

/// All queries: warps take tasks, which belong to many of them, until none is left.
template <Goal goal>
__global__ void __launch_bounds__(kBatchWarps* kWarp, kBatchBlocks)
    traverseBatch(const __grid_constant__ Batch batch) {
  constexpr unsigned kNone = ~0u;
  __shared__ WarpMemory memory[kBatchWarps];
  __shared__ Scene scenes[kBatchWarps];
  const unsigned lane = threadIdx.x % kWarp;
  Scene& scene = scenes[threadIdx.x / kWarp];
  Warp<goal> warp(memory[threadIdx.x / kWarp], lane);
  const unsigned tasks = batch.counters->tasks;
  const unsigned at_once = tasksAtOnce(tasks / (gridDim.x * kBatchWarps));
  const auto take = [&] { return lane == 0 ? atomicAdd(&batch.counters->taken, at_once) : 0; };
  unsigned taken = take(), at = 0, query = kNone;
  unsigned long long bits = 0;  // of the task
  Progress progress;            // in its first cluster
  bool left = true;
  while (left) {
    while (left && unpackTask(bits).mask == 0) {
      if (at % at_once == 0) {
        at = __shfl_sync(kAll, taken, 0);
        taken = take();  // ahead
      }
      left = at < tasks;
      if (left) bits = __ldg(batch.tasks + at++);
      if (goal == Goal::touch && left && isTouched(batch.sums[unpackTask(bits).query])) bits = 0;
    }
    const ClusterTask task = unpackTask(bits);
    const bool drain = !left || task.query != query;
    bool done = true;
    if (!drain) {
      const auto cluster = task.first + static_cast<unsigned>(__ffs(static_cast<int>(task.mask)) - 1);
      done = findCandidates(scene, {task.side, cluster, 0, 1}, progress, warp);
    }
    if (query != kNone) decide(batch, scene, query, drain, batch.sums[query], warp);
    if (!drain) {
      if (done) bits ^= task.mask & -task.mask;
      if (!warp.touched) continue;
      bits = 0;
      progress = {};
    }
    if (query != kNone) warp.flush(batch.sums[query], scene.query.units);
    if (!drain || !left) continue;
    query = task.query;
    __syncwarp();
    copyScene(batch.queries[query], lane, kWarp, scene);
    __syncwarp();
  }
}

/// Makes the query of a pose.
__global__ void prepareQueries(const __grid_constant__ Batch batch, Query* queries,
                               const __grid_constant__ core::SweptPair pair, const Grid* grid_a,
                               const Grid* grid_b, const Poses poses) {
  const unsigned number = blockIdx.x * blockDim.x + threadIdx.x;
  if (number >= batch.count) return;
  Query query{};
  query.grids[0] = grid_a;
  query.grids[1] = grid_b;
  const core::Fault fault = core::prepareAt(pair, poses, number, query);
  if (fault != core::Fault::none) {
    query.clusters[0] = query.clusters[1] = 0;
    atomicMax(&batch.counters->fault, packFault(fault, number));
  }
  queries[number] = query;
}

/// Returns word `word` of an Overlap: as toOverlap() does it, to the bit.
template <Goal goal>
__device__ unsigned long long overlapWord(const DeviceSums& sums, const core::Units& units, unsigned word) {
  const bool of_centroid = word >= core::kMoment && word < core::kMoment + 3;
  if (!of_centroid || goal == Goal::touch) return resultOf<goal>(sums, units, word);
  const double volume = totalOf(sums, units, core::kVolume);
  if (!(volume > 0)) return 0;
  return static_cast<unsigned long long>(
      __double_as_longlong(totalOf(sums, units, static_cast<int>(word)) / volume));
}

/// Brings the sums of all queries home.
template <Goal goal>
__global__ void finishBatch(const __grid_constant__ Batch batch) {
  const unsigned thread = blockIdx.x * blockDim.x + threadIdx.x, query = thread / kResultWords;
  if (query < batch.count) {
    const unsigned word = thread % kResultWords;
    const core::Units& units = batch.queries[query].units;
    if (batch.overlaps) {
      reinterpret_cast<unsigned long long*>(batch.overlaps + query)[word] =
          overlapWord<goal>(batch.sums[query], units, word);
    } else {
      reinterpret_cast<unsigned long long*>(batch.results + query)[word] =
          resultOf<goal>(batch.sums[query], units, word);
    }
  }
  __threadfence_system();
  if (!isLastBlock(batch) || threadIdx.x != 0) return;
  batch.signal->found = batch.counters->found;
  if (batch.counters->fault != 0 && batch.signal->fault == 0) {
    batch.signal->fault = batch.counters->fault;
    batch.signal->in_poses = batch.first_pose;
  }
  __threadfence_system();
  *static_cast<volatile unsigned*>(&batch.signal->done) = batch.run;
}

template <Goal goal>
void launchGoal(const Batch& batch, const Query* single, unsigned most_clusters, std::size_t most_tasks,
                unsigned processors, cudaStream_t stream) {
  if (single) {
    const unsigned clusters = single->clusters[0] + single->clusters[1];
    const unsigned blocks = std::min(kSingleBlocks * processors, clusters);
    traverseSingle<goal><<<blocks, kSingleWarps * kWarp, 0, stream>>>(batch, *single);
  } else {
    constexpr unsigned kWarpClusters = kWarp * kGroup, kThreads = 128;
    const unsigned warps = most_clusters / kWarpClusters + 2;  // of both bodies together
    cullClusters<<<dim3(batch.count, (warps + kCullWarps - 1) / kCullWarps), kCullWarps * kWarp, 0, stream>>>(
        batch);
    const auto blocks = static_cast<unsigned>(
        std::min<std::size_t>(kBatchBlocks * processors, (most_tasks + kBatchWarps - 1) / kBatchWarps));
    traverseBatch<goal><<<blocks, kBatchWarps * kWarp, 0, stream>>>(batch);
    finishBatch<goal><<<(batch.count * kResultWords + kThreads - 1) / kThreads, kThreads, 0, stream>>>(batch);
  }
  INNERSPHERE_CUDA(cudaGetLastError());
}

}  // namespace

void launchPreparation(const Batch& batch, Query* queries, const core::SweptPair& pair, const Grid* grid_a,
                       const Grid* grid_b, const Poses& poses, cudaStream_t stream) {
  constexpr unsigned kThreads = 128;
  prepareQueries<<<(batch.count + kThreads - 1) / kThreads, kThreads, 0, stream>>>(batch, queries, pair,
                                                                                   grid_a, grid_b, poses);
  INNERSPHERE_CUDA(cudaGetLastError());
}

void launchTraversal(Goal goal, const Batch& batch, const Query* single, unsigned most_clusters,
                     std::size_t most_tasks, unsigned processors, cudaStream_t stream) {
  const auto launch = goal == Goal::touch    ? &launchGoal<Goal::touch>
                      : goal == Goal::volume ? &launchGoal<Goal::volume>
                                             : &launchGoal<Goal::wrench>;
  launch(batch, single, most_clusters, most_tasks, processors, stream);
}

}  // namespace innersphere::device
