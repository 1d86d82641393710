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
    Walking walking;  ///< while candidates are found
    Columns columns;  ///< while they are decided
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

/// A cluster to walk, or a share of it: the rounds `part`, part + parts, ...
struct Job {
  unsigned side, cluster, part, parts;
};

/// How far a job has come.
struct Progress {
  std::uint32_t number = 0;  ///< of the walkers' cells
  unsigned round = 0;        ///< of the job in these cells
};

/// Queues a cluster's candidates. True at its end; false if the queue is full first. All lanes call it.
template <Goal goal>
__device__ __forceinline__ bool findCandidates(const Scene& scene, const Job& job, Progress& progress,
                                               Warp<goal>& warp) {
  const unsigned lane = warp.lane;
  const Grid &own = scene.grids[job.side], &grid = scene.grids[1 - job.side];
  const uint2 run = __ldg(reinterpret_cast<const uint2*>(&own.view.clusters[job.cluster].first));
  bool more = true;
  for (; more; ++progress.number, progress.round = 0) {
    core::Lookup lookup{};
    List list{};
    const core::Walker walker{own.view, grid.view, scene.query.searches[job.side]};
    std::uint32_t count = 0;
    if (lane < run.y && core::makeLookup(walker, load(own.view.spheres + run.x + lane), lookup))
      list = listOf(grid.view, lookup, progress.number, count);
    more = __any_sync(kAll, progress.number + 1 < count);
    const unsigned self = (run.x + lane) | (job.side == 0 ? kFromA : 0);
    const Lists lists = lineUp(lookup, list, self, lane, warp.memory.walking);
    while (true) {
      const unsigned first = (progress.round * job.parts + job.part) * kWarp;
      if (first >= lists.total) break;
      if (!testStep(grid, lists, progress.number, first, lane, warp.memory.walking, warp.memory.queue,
                    warp.queued))
        return false;
      ++progress.round;
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

/// Into how many jobs a cluster is cut: where a block has few, all its warps should get something.
__device__ unsigned partsOf(unsigned clusters) {
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
    walkSingle(const __grid_constant__ Batch batch, const __grid_constant__ Query query) {
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
    const unsigned parts = partsOf(active_count), jobs = parts * active_count;
    for (unsigned number = threadIdx.x / kWarp; number < jobs; number += kSingleWarps) {
      Job job{0, first + bitOf(active, number / parts) * gridDim.x, number % parts, parts};
      job.side = job.cluster < clusters_a ? 0 : 1;
      if (job.side != 0) job.cluster -= clusters_a;
      Progress progress;
      bool done;
      do {
        done = findCandidates(scene, job, progress, warp);
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
    auto* to = reinterpret_cast<ulonglong2*>(batch.signal->pieces) + threadIdx.x;
    *to = {run | (word & 0xffffffffu), run | word >> 32};
  }
  __syncthreads();
  if (threadIdx.x < kSumWords) reinterpret_cast<unsigned long long*>(batch.sums)[threadIdx.x] = 0;
  if (threadIdx.x == 0) *batch.counters = {};
}

/// A power of two: few enough that all warps end at about the same time.
__device__ unsigned itemsAtOnce(unsigned items_of_warp) {
  constexpr unsigned kShares = 8, kMost = 8;
  unsigned at_once = 1;
  while (at_once < kMost && 2 * at_once * kShares <= items_of_warp) at_once *= 2;
  return at_once;
}

/// All queries: warps take items, which belong to many of them, until none is left.
template <Goal goal>
__global__ void __launch_bounds__(kBatchWarps* kWarp, kBatchBlocks)
    walkBatch(const __grid_constant__ Batch batch) {
  constexpr unsigned kNone = ~0u;
  __shared__ WarpMemory memory[kBatchWarps];
  __shared__ Scene scenes[kBatchWarps];
  const unsigned lane = threadIdx.x % kWarp;
  Scene& scene = scenes[threadIdx.x / kWarp];
  Warp<goal> warp(memory[threadIdx.x / kWarp], lane);
  const unsigned items = batch.counters->items;
  const unsigned chunk = itemsAtOnce(items / (gridDim.x * kBatchWarps));
  const auto take = [&] { return lane == 0 ? atomicAdd(&batch.counters->taken, chunk) : 0; };
  unsigned taken = take(), at = 0, query = kNone;
  unsigned long long bits = 0;  // of the item
  Progress progress;            // in its first cluster
  bool left = true;
  while (left) {
    while (left && unpackItem(bits).mask == 0) {
      if (at % chunk == 0) {
        at = __shfl_sync(kAll, taken, 0);
        taken = take();  // ahead
      }
      left = at < items;
      if (left) bits = __ldg(batch.items + at++);
      if (goal == Goal::touch && left && isTouched(batch.sums[unpackItem(bits).query])) bits = 0;
    }
    const Item item = unpackItem(bits);
    const bool drain = !left || item.query != query;
    bool done = true;
    if (!drain) {
      const auto cluster = item.first + static_cast<unsigned>(__ffs(static_cast<int>(item.mask)) - 1);
      done = findCandidates(scene, {item.side, cluster, 0, 1}, progress, warp);
    }
    if (query != kNone) decide(batch, scene, query, drain, batch.sums[query], warp);
    if (!drain) {
      if (done) bits ^= item.mask & -item.mask;
      if (!warp.touched) continue;
      bits = 0;
      progress = {};
    }
    if (query != kNone) warp.flush(batch.sums[query], scene.query.units);
    if (!drain || !left) continue;
    query = item.query;
    __syncwarp();
    copyScene(batch.queries[query], lane, kWarp, scene);
    __syncwarp();
  }
}

/// Brings the sums of all queries home.
template <Goal goal>
__global__ void finishBatch(const __grid_constant__ Batch batch) {
  const unsigned thread = blockIdx.x * blockDim.x + threadIdx.x, query = thread / kResultWords;
  if (query < batch.count) {
    const unsigned word = thread % kResultWords;
    reinterpret_cast<unsigned long long*>(batch.results + query)[word] =
        resultOf<goal>(batch.sums[query], batch.queries[query].units, word);
  }
  __threadfence_system();
  if (!isLastBlock(batch) || threadIdx.x != 0) return;
  batch.signal->found = batch.counters->found;
  __threadfence_system();
  *static_cast<volatile unsigned*>(&batch.signal->done) = batch.run;
}

template <Goal goal>
void launchGoal(const Batch& batch, const Query* single, unsigned most_clusters, std::size_t most_items,
                unsigned processors, cudaStream_t stream) {
  if (single) {
    const unsigned clusters = single->clusters[0] + single->clusters[1];
    const unsigned blocks = std::min(kSingleBlocks * processors, clusters);
    walkSingle<goal><<<blocks, kSingleWarps * kWarp, 0, stream>>>(batch, *single);
  } else {
    constexpr unsigned kTask = kWarp * kGroup, kThreads = 128;
    const unsigned tasks = most_clusters / kTask + 2;  // of both bodies together
    cullClusters<<<dim3(batch.count, (tasks + kCullWarps - 1) / kCullWarps), kCullWarps * kWarp, 0, stream>>>(
        batch);
    const auto blocks = static_cast<unsigned>(
        std::min<std::size_t>(kBatchBlocks * processors, (most_items + kBatchWarps - 1) / kBatchWarps));
    walkBatch<goal><<<blocks, kBatchWarps * kWarp, 0, stream>>>(batch);
    finishBatch<goal><<<(batch.count * kResultWords + kThreads - 1) / kThreads, kThreads, 0, stream>>>(batch);
  }
  INNERSPHERE_CUDA(cudaGetLastError());
}

}  // namespace

void launchWalk(Goal goal, const Batch& batch, const Query* single, unsigned most_clusters,
                std::size_t most_items, unsigned processors, cudaStream_t stream) {
  const auto launch = goal == Goal::touch    ? &launchGoal<Goal::touch>
                      : goal == Goal::volume ? &launchGoal<Goal::volume>
                                             : &launchGoal<Goal::wrench>;
  launch(batch, single, most_clusters, most_items, processors, stream);
}

}  // namespace innersphere::device
