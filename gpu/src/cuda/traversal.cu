// The kernels of a batch: all its pairs, whose clusters the warps of the device share.
#include "cuda/cull.hpp"
#include "cuda/kernels.hpp"
#include "cuda/memory.hpp"
#include "cuda/traverse.hpp"

namespace innersphere::device {

namespace {

constexpr unsigned kBatchWarps = 4;   ///< in a block
constexpr unsigned kBatchBlocks = 7;  ///< on each multiprocessor, as many as registers allow
static_assert(kBatchWarps <= kMostWarps);

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
__device__ unsigned long long overlapWord(const DeviceSums& sums, const core::PairSetup& setup,
                                          unsigned word) {
  const core::Units& units = setup.units;
  if (word >= core::kVolumeTerms || goal == Goal::touch) return resultOf<goal>(sums, units, word);
  const double lenses = totalOf(sums, units, core::kVolume);
  double value = core::sharedVolume(lenses, setup);
  if (word != core::kVolume) value = lenses > 0 ? totalOf(sums, units, static_cast<int>(word)) / lenses : 0;
  return static_cast<unsigned long long>(__double_as_longlong(value));
}

/// Brings the sums of all queries home.
template <Goal goal>
__global__ void finishBatch(const __grid_constant__ Batch batch) {
  const unsigned thread = blockIdx.x * blockDim.x + threadIdx.x, query = thread / kResultWords;
  if (query < batch.count) {
    const unsigned word = thread % kResultWords;
    const core::PairSetup& setup = batch.queries[query];
    if (batch.overlaps) {
      reinterpret_cast<unsigned long long*>(batch.overlaps + query)[word] =
          overlapWord<goal>(batch.sums[query], setup, word);
    } else {
      reinterpret_cast<unsigned long long*>(batch.results + query)[word] =
          resultOf<goal>(batch.sums[query], setup.units, word);
    }
  }
  __threadfence_system();
  if (!isLastBlock(*batch.counters) || threadIdx.x != 0) return;
  batch.signal->found = batch.counters->found;
  if (batch.counters->fault != 0 && batch.signal->fault == 0) {
    batch.signal->fault = batch.counters->fault;
    batch.signal->in_poses = batch.first_pose;
  }
  __threadfence_system();
  *static_cast<volatile unsigned*>(&batch.signal->done) = batch.run;
}

template <Goal goal>
void launchGoal(const Batch& batch, unsigned most_clusters, std::size_t most_tasks, unsigned processors,
                cudaStream_t stream) {
  constexpr unsigned kWarpClusters = kWarp * kGroup, kThreads = 128;
  const unsigned warps = most_clusters / kWarpClusters + 2;  // of both bodies together
  cullClusters<<<dim3(batch.count, (warps + kCullWarps - 1) / kCullWarps), kCullWarps * kWarp, 0, stream>>>(
      batch);
  const auto blocks = static_cast<unsigned>(
      std::min<std::size_t>(kBatchBlocks * processors, (most_tasks + kBatchWarps - 1) / kBatchWarps));
  traverseBatch<goal><<<blocks, kBatchWarps * kWarp, 0, stream>>>(batch);
  finishBatch<goal><<<(batch.count * kResultWords + kThreads - 1) / kThreads, kThreads, 0, stream>>>(batch);
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

void launchTraversal(Goal goal, const Batch& batch, unsigned most_clusters, std::size_t most_tasks,
                     unsigned processors, cudaStream_t stream) {
  forGoal(goal, &launchGoal<Goal::touch>, &launchGoal<Goal::volume>, &launchGoal<Goal::wrench>)(
      batch, most_clusters, most_tasks, processors, stream);
}

}  // namespace innersphere::device
