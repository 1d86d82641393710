#include "cuda/cuda_backend.hpp"

#include <algorithm>
#include <array>

#include "batch/results.hpp"
#include "cuda/batch_part.hpp"

namespace innersphere {

namespace {

using device::BatchPart;

/// A batch goes in parts, two of them at a time, so that the device need not wait for the host.
class CudaBackend : public QueryBackend {
 public:
  CudaBackend(Workers& workers, bool time_kernels) : workers_(workers) {
    device_.time_kernels = time_kernels;
  }
  ~CudaBackend() override {
    if (!device_.stream) return;
    cudaStreamSynchronize(device_.stream);
    cudaStreamDestroy(device_.stream);
  }

  double kernelTime() const override { return kernel_time_; }

  void start(const std::vector<PreparedQuery>& queries, Want want) override {
    open();
    const CurrentDevice current(device_.number);
    discard();
    queries_ = &queries;
    want_ = want;
    next_ = first_ = 0;
    kernel_time_ = 0;
    staged_.overlaps.resize(queries.size());
    begin(staged_.pairs, want == Want::pairs);
    begin(staged_.contacts_a, wantsContacts(want));
    begin(staged_.contacts_b, want == Want::contacts);
    while (startPart()) continue;
  }

  bool ready() override {
    const CurrentDevice current(device_.number);
    while (under_way_ > 0 && oldest().advance()) collect();
    return under_way_ == 0;
  }

  void finish(QueryResult& result) override {
    const CurrentDevice current(device_.number);
    while (under_way_ > 0) {
      oldest().wait();
      collect();
    }
    std::swap(result, staged_);
  }

 private:
  void open() {
    if (device_.stream) return;
    INNERSPHERE_CUDA(cudaGetDevice(&device_.number));
    int processors = 1;
    INNERSPHERE_CUDA(cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device_.number));
    device_.processors = static_cast<unsigned>(processors);
    INNERSPHERE_CUDA(cudaStreamCreateWithFlags(&device_.stream, cudaStreamNonBlocking));
  }

  /// What is left of a batch that failed.
  void discard() {
    if (under_way_ > 0) cudaStreamSynchronize(device_.stream);
    under_way_ = 0;
  }

  /// What is wanted is overwritten, and then cut to its length: nothing is filled twice.
  template <typename T>
  void begin(QueryResult::Ranges<T>& ranges, bool wanted) {
    if (!wanted || queries_->empty()) ranges.items.clear();
    ranges.first.assign(queries_->size() + 1, 0);
  }

  BatchPart& oldest() { return parts_[first_ % parts_.size()]; }

  /// False if there is no other part, or no room for it now.
  bool startPart() {
    if (next_ == queries_->size() || under_way_ == parts_.size()) return false;
    BatchPart& part = parts_[(first_ + under_way_) % parts_.size()];
    const std::size_t end = BatchPart::endOf(*queries_, next_);
    part.start(device_, *queries_, {next_, end}, want_, workers_);
    ++under_way_;
    next_ = end;
    return true;
  }

  void collect() {
    const BatchPart& part = oldest();
    const BatchPart::Range range = part.range();
    for (std::size_t q = range.begin; q < range.end; ++q)
      staged_.overlaps[q] = toOverlap(part.results()[q - range.begin]);
    if (want_ == Want::pairs) append(part.lists().pairs, range, staged_.pairs);
    if (wantsContacts(want_)) append(part.lists().contacts[0], range, staged_.contacts_a);
    if (want_ == Want::contacts) append(part.lists().contacts[1], range, staged_.contacts_b);
    kernel_time_ += part.kernelTime();
    ++first_;
    --under_way_;
    startPart();
  }

  template <typename T>
  void append(const device::PinnedList<T>& from, BatchPart::Range range, QueryResult::Ranges<T>& to) {
    constexpr std::size_t kGrain = 4096;
    const std::size_t before = to.first[range.begin], count = from.first.data()[range.size()];
    to.items.resize(before + count);
    workers_.forRanges(count, kGrain, [&](std::size_t first, std::size_t end) {
      std::copy(from.items.data() + first, from.items.data() + end, to.items.data() + before + first);
    });
    for (std::size_t q = 0; q <= range.size(); ++q) to.first[range.begin + q] = before + from.first.data()[q];
  }

  Workers& workers_;
  device::Device device_;
  std::array<BatchPart, 2> parts_;
  const std::vector<PreparedQuery>* queries_ = nullptr;
  Want want_ = Want::wrench;
  std::size_t next_ = 0;       ///< query that no part has
  std::size_t first_ = 0;      ///< number of the oldest part under way
  std::size_t under_way_ = 0;  ///< parts
  QueryResult staged_;
  double kernel_time_ = 0;
};

}  // namespace

bool cudaDeviceAnswers() {
  int count = 0;
  const bool answers = cudaGetDeviceCount(&count) == cudaSuccess && count > 0;
  cudaGetLastError();
  return answers;
}

std::unique_ptr<QueryBackend> makeCudaBackend(Workers& workers, bool time_kernels) {
  if (!cudaDeviceAnswers()) {
    throw Error(ErrorCode::no_device,
                "no CUDA device answers; check the driver with nvidia-smi or use the CPU backend");
  }
  return std::make_unique<CudaBackend>(workers, time_kernels);
}

}  // namespace innersphere
