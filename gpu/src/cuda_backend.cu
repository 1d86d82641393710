// The CUDA backend: one launch for a whole batch, two copies, and what they need on the host.
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <vector>

#include "cuda_backend.hpp"
#include "cuda_grid.hpp"
#include "cuda_memory.hpp"
#include "cuda_walk.hpp"

namespace innersphere {

namespace {

using namespace device;

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
    if (countJobs(queries) == 0) return;

    Layout layout(queries.size());
    host_.reserve(layout.size);
    device_memory_.reserve(layout.size);
    gather(queries, layout);
    while (true) {
      launch(layout, queries.size(), want);
      if (!wantsHits(want)) break;
      hits.count = *layout.found(host_.data());
      if (hits.count <= device_hits_.capacity()) break;
      device_hits_.reserve(hits.count);  // now the room that is needed is known: walk again
    }
    for (std::size_t q = 0; q < queries.size(); ++q)
      toSums(layout.sums(host_.data())[q], queries[q].setup.units, sums[q]);
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
          at_first(at_sums + count * sizeof(DeviceSums)),
          at_setups((at_first + (count + 1) * sizeof(unsigned long long) + 15) / 16 * 16),
          size(at_setups + count * sizeof(core::Setup)) {}
    unsigned long long* found(std::byte* p) const { return reinterpret_cast<unsigned long long*>(p); }
    DeviceSums* sums(std::byte* p) const { return reinterpret_cast<DeviceSums*>(p + at_sums); }
    unsigned long long* first(std::byte* p) const {
      return reinterpret_cast<unsigned long long*>(p + at_first);
    }
    core::Setup* setups(std::byte* p) const { return reinterpret_cast<core::Setup*>(p + at_setups); }
    std::size_t at_sums, at_first, at_setups, size;
  };

  void open() {
    if (stream_) return;
    INNERSPHERE_CUDA(cudaGetDevice(&device_));
    INNERSPHERE_CUDA(cudaDeviceGetAttribute(&processors_, cudaDevAttrMultiProcessorCount, device_));
    INNERSPHERE_CUDA(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking));
  }

  /// A job should be long, to add its sums up once, but all multiprocessors should get some.
  std::size_t countJobs(const std::vector<PreparedQuery>& queries) {
    std::size_t clusters = 0;
    for (const PreparedQuery& query : queries) clusters += query.clusters();
    const std::size_t warps = kWarpsPerProcessor * static_cast<std::size_t>(processors_);
    if (clusters == 0) return jobs_ = 0;
    job_size_ = static_cast<unsigned>(std::clamp<std::size_t>(clusters / warps, 1, kLargestJob));
    jobs_ = 0;
    for (const PreparedQuery& query : queries) jobs_ += jobsOf(query);
    return jobs_;
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
  }

  void launch(const Layout& layout, std::size_t count, Want want) {
    std::byte* memory = device_memory_.data();
    std::memset(host_.data(), 0, layout.at_first);
    copyAsync(memory, host_.data(), layout.size, stream_);
    Batch batch{};
    batch.setups = layout.setups(memory);
    batch.first = layout.first(memory);
    batch.count = static_cast<unsigned>(count);
    batch.job_size = job_size_;
    batch.sums = layout.sums(memory);
    if (wantsHits(want)) {
      batch.hits = device_hits_.data();
      batch.capacity = device_hits_.capacity();
      batch.found = layout.found(memory);
    }
    const auto jobs = static_cast<unsigned>(jobs_);
    if (want == Want::touch) {
      walkBatch<Goal::touch><<<jobs, kWarp, 0, stream_>>>(batch);
    } else if (want == Want::volume) {
      walkBatch<Goal::volume><<<jobs, kWarp, 0, stream_>>>(batch);
    } else {
      walkBatch<Goal::wrench><<<jobs, kWarp, 0, stream_>>>(batch);
    }
    INNERSPHERE_CUDA(cudaGetLastError());
    copyAsync(host_.data(), memory, layout.at_first, stream_);
    INNERSPHERE_CUDA(cudaStreamSynchronize(stream_));
  }

  int device_ = 0;
  int processors_ = 1;
  unsigned job_size_ = 1;
  std::size_t jobs_ = 0;  ///< below 2^31, the most that one launch can have
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
