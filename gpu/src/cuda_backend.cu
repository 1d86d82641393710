// The CUDA backend: launches for a whole batch, two copies, and what they need on the host.
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <vector>

#include "cuda_backend.hpp"
#include "cuda_find.hpp"
#include "cuda_grid.hpp"
#include "cuda_memory.hpp"
#include "cuda_sum.hpp"

namespace innersphere {

namespace {

using namespace device;

class CudaBackend : public WalkBackend {
 public:
  explicit CudaBackend(bool time_kernels) : time_kernels_(time_kernels) {}
  ~CudaBackend() override {
    if (stream_) cudaStreamDestroy(stream_);
  }

  double kernelTime() const override { return kernel_time_; }

  void run(const std::vector<PreparedQuery>& queries, Want want, std::vector<core::Sums>& sums,
           Hits& hits) override {
    open();
    const CurrentDevice current(device_);
    sums.resize(queries.size());
    for (core::Sums& sum : sums) sum.clear();
    hits.count = 0;
    kernel_time_ = 0;
    if (countJobs(queries) == 0) return;

    const Layout layout(queries.size(), slices_.size());
    host_.reserve(layout.size);
    if (layout.size > device_memory_.capacity()) clean_ = false;
    device_memory_.reserve(layout.size);
    gather(queries, layout);
    do {
      launch(queries, layout, want);
      hits.count = *layout.found(host_.data());
    } while (grow(layout, hits.count));
    for (std::size_t q = 0; q < queries.size(); ++q)
      toSums(layout.sums(host_.data())[q], queries[q].setup.units, sums[q]);
    if (hits.items.size() < hits.count) hits.items.resize(hits.count);
    if (hits.count > 0) {
      copyAsync(hits.items.data(), device_hits_.data(), hits.count, stream_);
      INNERSPHERE_CUDA(cudaStreamSynchronize(stream_));
    }
  }

 private:
  /// Queries whose candidates are in memory at once.
  struct Slice {
    std::size_t begin, end;
    std::size_t first_job, jobs;
    std::size_t clusters;
  };

  /// One block of memory holds all that goes to the device and, in front, what comes back.
  struct Layout {
    Layout(std::size_t queries, std::size_t slices)
        : at_taken(16),
          at_sums((at_taken + slices * sizeof(unsigned long long) + 255) / 256 * 256),
          at_first(at_sums + queries * sizeof(DeviceSums)),
          at_setups((at_first + (queries + 1) * sizeof(unsigned long long) + 15) / 16 * 16),
          size(at_setups + queries * sizeof(core::Setup)) {}
    unsigned long long* found(std::byte* p) const { return reinterpret_cast<unsigned long long*>(p); }
    unsigned* ticket(std::byte* p) const { return reinterpret_cast<unsigned*>(p + 8); }
    unsigned long long* taken(std::byte* p) const {
      return reinterpret_cast<unsigned long long*>(p + at_taken);
    }
    DeviceSums* sums(std::byte* p) const { return reinterpret_cast<DeviceSums*>(p + at_sums); }
    unsigned long long* first(std::byte* p) const {
      return reinterpret_cast<unsigned long long*>(p + at_first);
    }
    core::Setup* setups(std::byte* p) const { return reinterpret_cast<core::Setup*>(p + at_setups); }
    std::size_t at_taken, at_sums, at_first, at_setups, size;
  };

  void open() {
    if (stream_) return;
    INNERSPHERE_CUDA(cudaGetDevice(&device_));
    INNERSPHERE_CUDA(cudaDeviceGetAttribute(&processors_, cudaDevAttrMultiProcessorCount, device_));
    INNERSPHERE_CUDA(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking));
  }

  /// A job should be long, to fill its chunks of candidates, but all multiprocessors should get some.
  std::size_t countJobs(const std::vector<PreparedQuery>& queries) {
    constexpr std::size_t kWarpsPerProcessor = 64;  // that there should be, at least
    constexpr std::size_t kSliceClusters = 1 << 20;
    constexpr unsigned kFew = 64;  // candidates: where there is little work, each warp gets little
    std::size_t clusters = 0;
    for (const PreparedQuery& query : queries) clusters += query.clusters();
    slices_.clear();
    if (clusters == 0) return 0;
    job_size_ = static_cast<unsigned>(std::clamp<std::size_t>(
        clusters / (kWarpsPerProcessor * static_cast<std::size_t>(processors_)), 1, kLargestJob));
    chunk_size_ = job_size_ == kLargestJob ? kLargestChunk : kFew;
    Slice slice{};
    for (std::size_t q = 0; q < queries.size(); ++q) {
      if (slice.clusters > kSliceClusters) {
        slices_.push_back(slice);
        slice = {q, q, slice.first_job + slice.jobs, 0, 0};
      }
      slice.end = q + 1;
      slice.jobs += jobsOf(queries[q]);
      slice.clusters += queries[q].clusters();
    }
    slices_.push_back(slice);
    return slice.first_job + slice.jobs;
  }

  std::size_t jobsOf(const PreparedQuery& query) const {
    return (query.clusters() + job_size_ - 1) / job_size_;
  }

  /// The queries with their grids on the device, and where the jobs of each begin.
  void gather(const std::vector<PreparedQuery>& queries, const Layout& layout) {
    core::Setup* setups = layout.setups(host_.data());
    unsigned long long* first = layout.first(host_.data());
    first[0] = 0;
    for (std::size_t q = 0; q < queries.size(); ++q) {
      setups[q] = queries[q].setup;
      first[q + 1] = first[q] + jobsOf(queries[q]);
      if (queries[q].clusters() == 0) continue;
      setups[q].a.grid = viewOnDevice(*queries[q].grid_a, device_, stream_);
      setups[q].b.grid = viewOnDevice(*queries[q].grid_b, device_, stream_);
    }
    std::size_t chunks = chunks_.capacity();
    for (const Slice& slice : slices_)  // a guess
      chunks = std::max(chunks, slice.jobs + slice.clusters * kWarp / 2 / chunk_size_);
    reserveChunks(chunks);
  }

  void reserveChunks(std::size_t count) {
    chunks_.reserve(count);
    candidates_.reserve(count * chunk_size_);
  }

  /// True if there was not enough room; now that what is needed is known, there is.
  bool grow(const Layout& layout, std::size_t hits) {
    const unsigned long long* taken = layout.taken(host_.data());
    const std::size_t chunks = *std::max_element(taken, taken + slices_.size());
    const bool few = chunks > chunkCapacity(), few_hits = hits > device_hits_.capacity();
    if (few) reserveChunks(chunks + chunks / 8);
    if (few_hits) device_hits_.reserve(hits);
    return few || few_hits;
  }

  std::size_t chunkCapacity() const {
    return std::min(chunks_.capacity(), candidates_.capacity() / chunk_size_);
  }

  void launch(const std::vector<PreparedQuery>& queries, const Layout& layout, Want want) {
    std::byte* memory = device_memory_.data();
    const bool returns = queries.size() == 1 && want != Want::touch;  // by itself, without a copy
    if (!returns || !clean_) INNERSPHERE_CUDA(cudaMemsetAsync(memory, 0, layout.at_first, stream_));
    clean_ = false;
    Batch batch{};
    batch.job_size = job_size_;
    batch.chunks = chunks_.data();
    batch.candidates = candidates_.data();
    batch.chunk_size = chunk_size_;
    batch.chunk_capacity = static_cast<unsigned>(chunkCapacity());
    if (wantsHits(want)) {
      batch.hits = device_hits_.data();
      batch.capacity = device_hits_.capacity();
      batch.found = layout.found(memory);
    }
    if (returns) {
      batch.words = layout.found(memory);
      batch.host_words = layout.found(host_.data());
      batch.word_count = static_cast<unsigned>(layout.at_first / sizeof(unsigned long long));
      batch.ticket = layout.ticket(memory);
    }
    if (queries.size() == 1) {
      batch.single = *layout.setups(host_.data());  // travels with the launch
    } else {
      copyAsync(memory + layout.at_first, host_.data() + layout.at_first, layout.size - layout.at_first,
                stream_);
      batch.setups = layout.setups(memory);
    }
    if (time_kernels_) INNERSPHERE_CUDA(cudaEventRecord(start_.get(), stream_));
    for (const Slice& slice : slices_) {
      if (slice.jobs == 0) continue;
      if (queries.size() > 1) batch.setups = layout.setups(memory) + slice.begin;
      batch.first = layout.first(memory) + slice.begin;
      batch.first_job = slice.first_job;
      batch.count = static_cast<unsigned>(slice.end - slice.begin);
      batch.first_query = static_cast<unsigned>(slice.begin);
      batch.sums = layout.sums(memory) + slice.begin;
      batch.taken = layout.taken(memory) + (&slice - slices_.data());
      batch.jobs = static_cast<unsigned>(slice.jobs);
      launchSlice(batch, want);
    }
    if (time_kernels_) INNERSPHERE_CUDA(cudaEventRecord(stop_.get(), stream_));
    if (!returns) copyAsync(host_.data(), memory, layout.at_first, stream_);
    INNERSPHERE_CUDA(cudaStreamSynchronize(stream_));
    clean_ = returns;
    if (time_kernels_) kernel_time_ = secondsBetween(start_, stop_);
  }

  void launchSlice(const Batch& batch, Want want) {
    const unsigned jobs = (batch.jobs + kFindWarps - 1) / kFindWarps;
    constexpr unsigned kBlocks = 3;  // of the second kernel, at once on a multiprocessor
    const unsigned blocks = kBlocks * static_cast<unsigned>(processors_);
    if (want == Want::touch) {
      findCandidates<true><<<jobs, kFindWarps * kWarp, 0, stream_>>>(batch);
    } else {
      findCandidates<false><<<jobs, kFindWarps * kWarp, 0, stream_>>>(batch);
      if (want == Want::volume) {
        sumCandidates<Goal::volume><<<blocks, kSumWarps * kWarp, 0, stream_>>>(batch);
      } else {
        sumCandidates<Goal::wrench><<<blocks, kSumWarps * kWarp, 0, stream_>>>(batch);
      }
    }
    INNERSPHERE_CUDA(cudaGetLastError());
  }

  int device_ = 0;
  int processors_ = 1;
  unsigned job_size_ = 1;
  unsigned chunk_size_ = kLargestChunk;
  std::vector<Slice> slices_;
  cudaStream_t stream_ = nullptr;
  bool time_kernels_;
  double kernel_time_ = 0;
  Event start_, stop_;
  PinnedArray<std::byte> host_;
  DeviceArray<std::byte> device_memory_;
  bool clean_ = false;  ///< what the kernels count in is zero
  DeviceArray<Chunk> chunks_;
  DeviceArray<uint2> candidates_;
  DeviceArray<Hit> device_hits_;
};

}  // namespace

bool cudaDeviceAnswers() {
  int count = 0;
  const bool answers = cudaGetDeviceCount(&count) == cudaSuccess && count > 0;
  cudaGetLastError();
  return answers;
}

std::unique_ptr<WalkBackend> makeCudaBackend(bool time_kernels) {
  if (!cudaDeviceAnswers()) {
    throw Error(ErrorCode::no_device,
                "no CUDA device answers; check the driver with nvidia-smi or use the CPU backend");
  }
  return std::make_unique<CudaBackend>(time_kernels);
}

}  // namespace innersphere
