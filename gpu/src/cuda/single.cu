// The kernels of a single query: one that is launched for it, and one that stays and waits for the next.
#include <algorithm>

#include "cuda/kernels.hpp"
#include "cuda/memory.hpp"
#include "cuda/traverse.hpp"

namespace innersphere::device {

namespace {

constexpr unsigned kSingleWarps = 8;   ///< in a block
constexpr unsigned kSingleBlocks = 2;  ///< on each multiprocessor, as many as registers allow
constexpr unsigned kThreads = kSingleWarps * kWarp;
static_assert(kSingleWarps <= kMostWarps);

/// What the threads of a block share.
struct BlockMemory {
  WarpMemory warps[kSingleWarps];
  Scene scene;
  unsigned active[kSingleWarps];  ///< a bit for each thread whose cluster is
  unsigned queued[kSingleWarps];
  DeviceSums total;
};
static_assert(sizeof(BlockMemory) <= 48 << 10, "more would have to be asked for");

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
__device__ __forceinline__ void decideTogether(const Batch& batch, DeviceSums& sums, BlockMemory& shared,
                                               Warp<goal>& warp) {
  const unsigned number = threadIdx.x / kWarp;
  const unsigned(&queued)[kSingleWarps] = shared.queued;
  if (warp.lane == 0) shared.queued[number] = warp.queued;
  warp.queued = 0;
  __syncthreads();
  unsigned all = 0;
  for (const unsigned of_warp : queued) all += of_warp;
  for (unsigned first = number * kWarp; first < all; first += kSingleWarps * kWarp) {
    unsigned at = min(first + warp.lane, all - 1), owner = 0;
    for (; at >= queued[owner]; ++owner) at -= queued[owner];
    WarpMemory& own = warp.memory;
    warp.summer.add(batch, shared.scene, 0, shared.warps[owner].queue[at], first + warp.lane < all, warp.lane,
                    own.columns, own.sums);
    if (warp.summer.full()) warp.summer.flush(sums, shared.scene.query.units, warp.lane, own.sums);
  }
}

/// One query: blocks share all its clusters, the warps of a block those that can meet the other body, and the
/// last block brings the sums home. There are kSumCopies of `sums`, so that fewer blocks wait for each other;
/// they and `counters` are zero before and after.
template <Goal goal>
__device__ __forceinline__ void traverse(const Batch& batch, unsigned run, DeviceSums* all_sums,
                                         Counters& counters, BlockMemory& shared) {
  const Scene& scene = shared.scene;
  DeviceSums& sums = all_sums[goal == Goal::touch ? 0 : blockIdx.x % kSumCopies];
  Warp<goal> warp(shared.warps[threadIdx.x / kWarp], threadIdx.x % kWarp);
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
    if (warp.lane == 0) shared.active[threadIdx.x / kWarp] = meeting;
    __syncthreads();
    unsigned active_count = 0;
    for (const unsigned of_warp : shared.active) active_count += __popc(of_warp);
    const unsigned slices = slicesOf(active_count), all_slices = slices * active_count;
    for (unsigned number = threadIdx.x / kWarp; number < all_slices; number += kSingleWarps) {
      ClusterSlice slice{0, first + bitOf(shared.active, number / slices) * gridDim.x, number % slices,
                         slices};
      slice.side = slice.cluster < clusters_a ? 0 : 1;
      if (slice.side != 0) slice.cluster -= clusters_a;
      Progress progress;
      bool done;
      do {
        done = findCandidates(scene, slice, progress, warp);
        if (!done || goal == Goal::touch) decide(batch, scene, 0, done, sums, warp);
      } while (!done && !warp.touched);
      if (goal == Goal::touch && warp.touched) warp.flush(sums, scene.query.units);  // for all to see
      if (goal == Goal::touch && isTouched(sums)) break;
    }
    decideTogether(batch, sums, shared, warp);
  }
  warp.summer.flushBlock(sums, scene.query.units, kSingleWarps, warp.lane,
                         [&](unsigned w) -> Sums& { return shared.warps[w].sums; });
  if (!isLastBlock(counters)) return;
  for (unsigned i = threadIdx.x; i < kSumWords; i += kThreads) {
    auto* const words = reinterpret_cast<unsigned long long*>(all_sums) + i;
    unsigned long long sum = 0;
    for (unsigned copy = 0; copy < kSumCopies; ++copy) sum += __ldcg(words + copy * kSumWords);
    for (unsigned copy = 0; copy < kSumCopies; ++copy) words[copy * kSumWords] = 0;
    reinterpret_cast<unsigned long long*>(&shared.total)[i] = sum;
  }
  __syncthreads();
  if (threadIdx.x <= kResultWords) {
    const unsigned long long word = threadIdx.x < kResultWords
                                        ? resultOf<goal>(shared.total, scene.query.units, threadIdx.x)
                                        : __ldcg(&counters.found);
    const unsigned long long above = static_cast<unsigned long long>(run) << 32;
    auto* to = reinterpret_cast<ulonglong2*>(batch.signal->halves) + threadIdx.x;
    *to = {above | (word & 0xffffffffu), above | word >> 32};
  }
  __syncthreads();
  if (threadIdx.x == 0) counters = {};
}

template <Goal goal>
__global__ void __launch_bounds__(kThreads, kSingleBlocks)
    traverseSingle(const __grid_constant__ Batch batch, const __grid_constant__ Query query) {
  extern __shared__ uint4 shared_bytes[];
  BlockMemory& shared = *reinterpret_cast<BlockMemory*>(shared_bytes);
  copyScene(query, threadIdx.x, kThreads, shared.scene);
  __syncthreads();
  traverse<goal>(batch, batch.run, batch.sums, *batch.counters, shared);
}

__device__ unsigned long long nanoseconds() {
  unsigned long long now;
  asm volatile("mov.u64 %0, %globaltimer;" : "=l"(now));
  return now;
}

/// Waits for the question of a run. Returns false if the kernel should leave: it was told to, or nothing came
/// for long. The first block looks into the memory of the host, and passes on what it finds. All threads of
/// all blocks call it.
__device__ bool receive(const Mailbox& mailbox, unsigned run, Query& query) {
  const unsigned thread = threadIdx.x;
  const bool first_block = blockIdx.x == 0, has_half = thread < kQuestionHalves;
  const volatile unsigned long long* const from =
      (first_block ? mailbox.question : mailbox.relay + blockIdx.x % kRelays * kQuestionHalves) + thread;
  const unsigned long long began = nanoseconds();
  unsigned long long half = 0;
  while (true) {
    bool come = true;
    if (has_half) {
      half = *from;
      come = half >> 32 == run;
    }
    if (__syncthreads_and(come)) break;
    if (!first_block) continue;
    if (!__syncthreads_or(thread == 0 && nanoseconds() - began > mailbox.idle)) continue;
    half = static_cast<unsigned long long>(run) << 32 | (thread == 0 ? kLeave : kAsk);
    break;
  }
  if (first_block && has_half) {
    volatile unsigned long long* to = mailbox.relay + thread;
    for (unsigned i = 0; i < kRelays; ++i) to[i * kQuestionHalves] = half;
  }
  const auto bits = static_cast<unsigned>(half);
  if (thread > 0 && has_half) reinterpret_cast<unsigned*>(&query)[thread - 1] = bits;
  return !__syncthreads_or(thread == 0 && bits == kLeave);
}

/// Answers one question after the other, until it should leave.
template <Goal goal>
__global__ void __launch_bounds__(kThreads, kSingleBlocks)
    traverseResident(const __grid_constant__ Batch batch, const __grid_constant__ Mailbox mailbox) {
  static_assert(kQuestionHalves <= kThreads);
  extern __shared__ uint4 shared_bytes[];
  BlockMemory& shared = *reinterpret_cast<BlockMemory*>(shared_bytes);
  for (unsigned side = 0; side < 2; ++side) {
    constexpr unsigned kWords = sizeof(Grid) / sizeof(uint2);
    for (unsigned i = threadIdx.x; i < kWords; i += kThreads)
      reinterpret_cast<uint2*>(&shared.scene.grids[side])[i] =
          reinterpret_cast<const uint2*>(mailbox.grids[side])[i];
  }
  // The sums of one run are cleared while the next one may begin, so they take turns.
  for (unsigned run = batch.run; receive(mailbox, run, shared.scene.query); ++run)
    traverse<goal>(batch, run, batch.sums + run % 2 * kSumCopies, batch.counters[run % 2], shared);
  if (blockIdx.x == 0 && threadIdx.x == 0)
    *static_cast<volatile unsigned*>(&batch.signal->left) = mailbox.number;
}

template <Goal goal>
void launchGoal(const Batch& batch, const Query& query, unsigned processors, cudaStream_t stream) {
  const unsigned blocks = std::min(kSingleBlocks * processors, query.clusters[0] + query.clusters[1]);
  traverseSingle<goal><<<blocks, kThreads, sizeof(BlockMemory), stream>>>(batch, query);
  INNERSPHERE_CUDA(cudaGetLastError());
}

template <Goal goal>
void launchResidentGoal(const Batch& batch, const Mailbox& mailbox, unsigned clusters, unsigned processors,
                        cudaStream_t stream) {
  int side_by_side = 0;  // they wait for each other
  INNERSPHERE_CUDA(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&side_by_side, traverseResident<goal>,
                                                                 kThreads, sizeof(BlockMemory)));
  const unsigned blocks = std::min(static_cast<unsigned>(side_by_side) * processors, clusters);
  Batch batch_argument = batch;
  Mailbox mailbox_argument = mailbox;
  void* arguments[] = {&batch_argument, &mailbox_argument};
  INNERSPHERE_CUDA(cudaLaunchCooperativeKernel(traverseResident<goal>, blocks, kThreads, arguments,
                                               sizeof(BlockMemory), stream));
}

}  // namespace

void launchSingle(Goal goal, const Batch& batch, const Query& query, unsigned processors,
                  cudaStream_t stream) {
  forGoal(goal, &launchGoal<Goal::touch>, &launchGoal<Goal::volume>, &launchGoal<Goal::wrench>)(
      batch, query, processors, stream);
}

void launchResident(Goal goal, const Batch& batch, const Mailbox& mailbox, unsigned clusters,
                    unsigned processors, cudaStream_t stream) {
  forGoal(goal, &launchResidentGoal<Goal::touch>, &launchResidentGoal<Goal::volume>,
          &launchResidentGoal<Goal::wrench>)(batch, mailbox, clusters, processors, stream);
}

}  // namespace innersphere::device
