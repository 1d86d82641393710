// The walk on an NVIDIA GPU: one launch for a whole batch, a warp for each cluster of 32 neighbouring
// spheres, a lane for each sphere. The lanes run the same functions as the CPU.
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <vector>

#include "core/walk.hpp"
#include "cuda_backend.hpp"
#include "cuda_grid.hpp"
#include "cuda_memory.hpp"

namespace innersphere {

namespace {

constexpr unsigned kWarp = 32;
constexpr unsigned kBlock = 128;
static_assert(core::kClusterSize == kWarp, "a warp walks one cluster");

constexpr unsigned kQueue = 256;  ///< candidates that a warp keeps before it tests them together

/// Arguments of the launch; pointers to the device.
struct Batch {
  const core::Setup* setups;
  const unsigned long long* first;  ///< clusters of all queries before each
  unsigned count;
  bool wrench;
  core::Sums* sums;
  Hit* hits;
  unsigned long long capacity;  ///< of hits
  unsigned long long* found;    ///< hits, also those beyond the capacity; null if none are wanted
};

/// What a warp works on.
struct Job {
  unsigned query;
  std::uint32_t cluster;
};

/// False if there is nothing left for this warp.
__device__ bool findJob(const Batch& batch, Job& job) {
  const unsigned long long warp =
      (static_cast<unsigned long long>(blockIdx.x) * kBlock + threadIdx.x) / kWarp;
  if (warp >= batch.first[batch.count]) return false;
  unsigned lo = 0, hi = batch.count;
  while (hi - lo > 1) {
    const unsigned middle = lo + (hi - lo) / 2;
    (batch.first[middle] <= warp ? lo : hi) = middle;
  }
  job = {lo, static_cast<std::uint32_t>(warp - batch.first[lo])};
  return true;
}

/// Integer addition in two halves; the order of the additions does not matter to the result.
__device__ void atomicAddFixed(core::FixedSum& sum, const core::FixedSum& x) {
  const unsigned long long before = atomicAdd(&sum.lo, x.lo);
  const unsigned long long carry = before + x.lo < before ? 1 : 0;
  if (x.hi + carry != 0) atomicAdd(&sum.hi, x.hi + carry);
}

/// Adds the sums of all lanes of a warp to those of the query.
__device__ void addWarp(core::Sums& total, core::Sums sums, int terms) {
  constexpr unsigned kAll = 0xffffffffu;
  if (!__any_sync(kAll, sums.pairs != 0)) return;
  const bool leader = threadIdx.x % kWarp == 0;
  for (unsigned step = kWarp / 2; step > 0; step /= 2) sums.pairs += __shfl_down_sync(kAll, sums.pairs, step);
  if (leader) atomicAdd(&total.pairs, sums.pairs);
#pragma unroll
  for (int i = 0; i < core::kTerms; ++i) {
    if (i >= terms) continue;
    core::FixedSum sum = sums.terms[i];
    for (unsigned step = kWarp / 2; step > 0; step /= 2) {
      sum = sum + core::FixedSum{__shfl_down_sync(kAll, sum.lo, step), __shfl_down_sync(kAll, sum.hi, step)};
    }
    if (leader) atomicAddFixed(total.terms[i], sum);
  }
}

/// Tests one candidate and adds it if it overlaps.
__device__ void addCandidate(const Batch& batch, const Job& job, std::uint32_t a, std::uint32_t b,
                             core::Sums& sums) {
  const core::Setup& setup = batch.setups[job.query];
  core::Pair pair;
  if (!core::isHit(setup, core::isFromA(setup, job.cluster), a, b, pair)) return;
  sums.add(pair, setup.shifts, batch.wrench);
  if (!batch.found) return;
  const unsigned long long at = atomicAdd(batch.found, 1ull);
  if (at < batch.capacity) batch.hits[at] = {job.query, setup.a.grid.ids[a], setup.b.grid.ids[b]};
}

/// For the rare candidate that finds the queue full. Apart, so that it does not take registers from the walk.
__device__ __noinline__ void addAtOnce(const Batch& batch, const Job& job, std::uint32_t a, std::uint32_t b) {
  core::Sums sums;
  sums.clear();
  addCandidate(batch, job, a, b, sums);
  core::Sums& total = batch.sums[job.query];
  if (sums.pairs == 0) return;
  atomicAdd(&total.pairs, sums.pairs);
  for (int i = 0; i < core::kTerms; ++i) atomicAddFixed(total.terms[i], sums.terms[i]);
}

/// The lanes of a warp find candidates at different times. They queue them, and then evaluate them side by
/// side.
__global__ void __launch_bounds__(kBlock) walkBatch(const __grid_constant__ Batch batch) {
  __shared__ uint2 queues[kBlock / kWarp][kQueue];
  __shared__ unsigned sizes[kBlock / kWarp];
  uint2* queue = queues[threadIdx.x / kWarp];
  unsigned* size = &sizes[threadIdx.x / kWarp];
  const unsigned lane = threadIdx.x % kWarp;
  Job job;
  if (!findJob(batch, job)) return;
  if (lane == 0) *size = 0;
  __syncwarp();
  core::walkCandidates(batch.setups[job.query], job.cluster, lane, kWarp,
                       [&](std::uint32_t a, std::uint32_t b) {
                         const unsigned at = atomicAdd(size, 1u);
                         if (at < kQueue) {
                           queue[at] = {a, b};
                         } else {
                           addAtOnce(batch, job, a, b);
                         }
                         return true;
                       });
  __syncwarp();
  core::Sums sums;
  sums.clear();
  const unsigned queued = min(*size, kQueue);
  for (unsigned k = lane; k < queued; k += kWarp) addCandidate(batch, job, queue[k].x, queue[k].y, sums);
  __syncwarp();
  addWarp(batch.sums[job.query], sums, batch.wrench ? core::kTerms : core::kVolumeTerms);
}

/// Want::touch: sets the pair count to 1 at the first hit, and then the other warps of the query have nothing
/// to do.
__global__ void __launch_bounds__(kBlock) touchBatch(const __grid_constant__ Batch batch) {
  Job job;
  if (!findJob(batch, job)) return;
  unsigned long long* touched = &batch.sums[job.query].pairs;
  if (*static_cast<volatile unsigned long long*>(touched) != 0) return;
  const core::Setup& setup = batch.setups[job.query];
  const bool from_a = core::isFromA(setup, job.cluster);
  core::walkCandidates(setup, job.cluster, threadIdx.x % kWarp, kWarp, [&](std::uint32_t a, std::uint32_t b) {
    core::Pair pair;
    if (!core::isHit(setup, from_a, a, b, pair)) return true;
    atomicExch(touched, 1ull);
    return false;
  });
}

class CudaBackend : public WalkBackend {
 public:
  ~CudaBackend() override {
    if (stream_) cudaStreamDestroy(stream_);
  }

  void run(const std::vector<PreparedQuery>& queries, Want want, std::vector<core::Sums>& sums,
           Hits& hits) override {
    open();
    const CurrentDevice current(device_);
    sums.resize(queries.size());
    for (core::Sums& sum : sums) sum.clear();
    hits.count = 0;
    std::size_t clusters = 0;
    for (const PreparedQuery& query : queries) clusters += query.clusters();
    if (clusters == 0) return;

    Layout layout(queries.size());
    host_.reserve(layout.size);
    device_memory_.reserve(layout.size);
    gather(queries, layout);
    while (true) {
      launch(layout, queries.size(), clusters, want);
      if (!wantsHits(want)) break;
      hits.count = *layout.found(host_.data());
      if (hits.count <= device_hits_.capacity()) break;
      device_hits_.reserve(hits.count);  // now the room that is needed is known: walk again
    }
    std::copy_n(layout.sums(host_.data()), sums.size(), sums.begin());
    if (hits.items.size() < hits.count) hits.items.resize(hits.count);
    if (hits.count > 0) {
      copyAsync(hits.items.data(), device_hits_.data(), hits.count, stream_);
      INNERSPHERE_CUDA(cudaStreamSynchronize(stream_));
    }
  }

 private:
  /// One block of memory holds all that goes to the device and, in front, what comes back: two copies a
  /// batch.
  struct Layout {
    explicit Layout(std::size_t count)
        : at_sums(256),
          at_first(at_sums + count * sizeof(core::Sums)),
          at_setups((at_first + (count + 1) * sizeof(unsigned long long) + 15) / 16 * 16),
          size(at_setups + count * sizeof(core::Setup)) {}
    unsigned long long* found(std::byte* p) const { return reinterpret_cast<unsigned long long*>(p); }
    core::Sums* sums(std::byte* p) const { return reinterpret_cast<core::Sums*>(p + at_sums); }
    unsigned long long* first(std::byte* p) const {
      return reinterpret_cast<unsigned long long*>(p + at_first);
    }
    core::Setup* setups(std::byte* p) const { return reinterpret_cast<core::Setup*>(p + at_setups); }
    std::size_t at_sums, at_first, at_setups, size;
  };

  void open() {
    if (stream_) return;
    INNERSPHERE_CUDA(cudaGetDevice(&device_));
    INNERSPHERE_CUDA(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking));
  }

  /// The queries with their grids on the device, and where the clusters of each begin.
  void gather(const std::vector<PreparedQuery>& queries, const Layout& layout) {
    core::Setup* setups = layout.setups(host_.data());
    unsigned long long* first = layout.first(host_.data());
    first[0] = 0;
    for (std::size_t q = 0; q < queries.size(); ++q) {
      setups[q] = queries[q].setup;
      first[q + 1] = first[q] + queries[q].clusters();
      if (queries[q].clusters() == 0) continue;
      setups[q].a.grid = viewOnDevice(*queries[q].grid_a, device_, stream_);
      setups[q].b.grid = viewOnDevice(*queries[q].grid_b, device_, stream_);
    }
  }

  void launch(const Layout& layout, std::size_t count, std::size_t clusters, Want want) {
    std::byte* memory = device_memory_.data();
    std::memset(host_.data(), 0, layout.at_first);
    copyAsync(memory, host_.data(), layout.size, stream_);
    Batch batch{};
    batch.setups = layout.setups(memory);
    batch.first = layout.first(memory);
    batch.count = static_cast<unsigned>(count);
    batch.wrench = want != Want::volume;
    batch.sums = layout.sums(memory);
    if (wantsHits(want)) {
      batch.hits = device_hits_.data();
      batch.capacity = device_hits_.capacity();
      batch.found = layout.found(memory);
    }
    constexpr std::size_t kWarps = kBlock / kWarp;
    const auto blocks = static_cast<unsigned>((clusters + kWarps - 1) / kWarps);
    if (want == Want::touch) {
      touchBatch<<<blocks, kBlock, 0, stream_>>>(batch);
    } else {
      walkBatch<<<blocks, kBlock, 0, stream_>>>(batch);
    }
    INNERSPHERE_CUDA(cudaGetLastError());
    copyAsync(host_.data(), memory, layout.at_first, stream_);
    INNERSPHERE_CUDA(cudaStreamSynchronize(stream_));
  }

  int device_ = 0;
  cudaStream_t stream_ = nullptr;
  PinnedArray<std::byte> host_;
  DeviceArray<std::byte> device_memory_;
  DeviceArray<Hit> device_hits_;
};

}  // namespace

bool cudaDeviceAnswers() {
  int count = 0;
  const bool answers = cudaGetDeviceCount(&count) == cudaSuccess && count > 0;
  cudaGetLastError();
  return answers;
}

std::unique_ptr<WalkBackend> makeCudaBackend() {
  if (!cudaDeviceAnswers()) {
    throw Error(ErrorCode::no_device,
                "no CUDA device answers; check the driver with nvidia-smi or use the CPU backend");
  }
  return std::make_unique<CudaBackend>();
}

}  // namespace innersphere
