#include "cuda/cuda_backend.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <string>
#include <utility>
#include <vector>

#include "batch/results.hpp"
#include "cuda/batch_part.hpp"
#include "cuda/split_backend.hpp"

namespace innersphere {

namespace {

using device::BatchPart;

/// A batch goes in parts, two of them at a time, so that the device need not wait for the host.
class CudaBackend : public OneDevice {
 public:
  /// `device` is a number, or kCurrentDevice.
  CudaBackend(Workers& workers, const QueryContextOptions& options, int device) : workers_(workers) {
    device_.number = device;
    device_.time_kernels = options.time_kernels;
    device_.resident_seconds = options.time_kernels ? 0 : options.resident_seconds;
  }
  ~CudaBackend() override {
    if (!device_.stream) return;
    for (BatchPart& part : parts_) part.dismiss();
    if (streaming_) cudaStreamSynchronize(users_.stream);
    cudaStreamSynchronize(device_.stream);
    cudaStreamDestroy(device_.stream);
  }

  double kernelTime() const override { return kernel_time_; }

  void start(std::span<const PreparedQuery> queries, Want want) override {
    open();
    const CurrentDevice current(device_.number);
    discard();
    queries_ = queries;
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

  void sweep(const Sweep& sweep, Overlap* overlaps) override {
    std::atomic<std::size_t> next{0};
    sweepParts(sweep, BatchPart::mostPoses(sweep), next, overlaps).throwIfAny();
  }

  SweepFault sweepParts(const Sweep& sweep, std::size_t poses, std::atomic<std::size_t>& next,
                        Overlap* overlaps) override {
    open();
    const CurrentDevice current(device_.number);
    discard();
    // Who filled the caller's arrays may still be at it, in the default stream or in one that waits for it.
    INNERSPHERE_CUDA(cudaEventRecord(filled_.get(), cudaStreamLegacy));
    INNERSPHERE_CUDA(cudaStreamWaitEvent(device_.stream, filled_.get()));
    poses = std::min(poses, BatchPart::mostPoses(sweep));
    kernel_time_ = 0;
    SweepFault fault;
    std::size_t started = 0, collected = 0;
    const auto collect = [&] {
      BatchPart& part = parts_[collected++ % parts_.size()];
      fault.take(part.collectSweep());
      kernel_time_ += part.kernelTime();
    };
    try {
      while (fault.fault == core::Fault::none) {
        const std::size_t begin = next.fetch_add(poses);
        if (begin >= sweep.poses.count) break;
        if (started - collected == parts_.size()) collect();
        const BatchPart::Range range{begin, std::min(begin + poses, sweep.poses.count)};
        parts_[started % parts_.size()].startSweep(device_, sweep, range, overlaps);
        ++started;
      }
      while (collected < started) collect();
    } catch (...) {
      cudaStreamSynchronize(device_.stream);
      throw;
    }
    if (fault.fault != core::Fault::none) next = sweep.poses.count;  // others need not go on
    return fault;
  }

  void startSweep(const Sweep& sweep, Overlap* overlaps, void* stream) override {
    open();
    const CurrentDevice current(device_.number);
    const Poses& poses = sweep.poses;
    for (const void* array :
         {static_cast<const void*>(overlaps), static_cast<const void*>(poses.matrices),
          static_cast<const void*>(poses.positions), static_cast<const void*>(poses.quaternions)}) {
      if (array && !memoryOf(array).isReachedFrom(device_.number))
        throw Error(ErrorCode::bad_argument,
                    "an array of a sweep in a stream is neither in memory of the device nor pinned");
    }
    if (!streaming_) {
      discard();
      parts_[0].clearFault();
      users_ = device_;
      users_.stream = static_cast<cudaStream_t>(stream);
      users_.time_kernels = false;
      kernel_time_ = 0;
    } else if (users_.stream != stream) {
      throw Error(ErrorCode::bad_argument, "sweeps are under way in another stream; wait for them first");
    }
    streaming_ = true;
    parts_[0].streamSweep(users_, sweep, overlaps);
  }

  void finishSweeps() override {
    if (!std::exchange(streaming_, false)) return;
    const CurrentDevice current(device_.number);
    INNERSPHERE_CUDA(cudaStreamSynchronize(users_.stream));
    parts_[0].fault().throwIfAny();
  }

 private:
  void open() {
    if (device_.stream) return;
    if (device_.number == kCurrentDevice) INNERSPHERE_CUDA(cudaGetDevice(&device_.number));
    const CurrentDevice current(device_.number);
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
    if (!wanted || queries_.empty()) ranges.items.clear();
    ranges.first.assign(queries_.size() + 1, 0);
  }

  BatchPart& oldest() { return parts_[first_ % parts_.size()]; }

  /// False if there is no other part, or no room for it now.
  bool startPart() {
    if (next_ == queries_.size() || under_way_ == parts_.size()) return false;
    BatchPart& part = parts_[(first_ + under_way_) % parts_.size()];
    const std::size_t end = BatchPart::endOf(queries_, next_);
    part.start(device_, queries_, {next_, end}, want_, workers_);
    ++under_way_;
    next_ = end;
    return true;
  }

  void collect() {
    const BatchPart& part = oldest();
    const BatchPart::Range range = part.range();
    for (std::size_t q = range.begin; q < range.end; ++q)
      staged_.overlaps[q] = toOverlap(part.results()[q - range.begin], queries_[q].setup);
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
  Event filled_;  ///< since which a sweep's arrays hold what they should
  std::array<BatchPart, 2> parts_;
  std::span<const PreparedQuery> queries_;
  Want want_ = Want::wrench;
  std::size_t next_ = 0;       ///< query that no part has
  std::size_t first_ = 0;      ///< number of the oldest part under way
  std::size_t under_way_ = 0;  ///< parts
  QueryResult staged_;
  device::Device users_;    ///< with the stream of the user's that sweeps are in
  bool streaming_ = false;  ///< sweeps are under way there
  double kernel_time_ = 0;
};

}  // namespace

bool cudaDeviceAnswers() {
  return cudaDevices() > 0;
}

int cudaDevices() {
  int count = 0;
  const bool answers = cudaGetDeviceCount(&count) == cudaSuccess;
  cudaGetLastError();
  return answers ? count : 0;
}

bool isOnCudaDevice(const void* p) {
  return cudaDeviceAnswers() && memoryOf(p).device >= 0;
}

std::unique_ptr<QueryBackend> makeCudaBackend(Workers& workers, const QueryContextOptions& options) {
  const int device = options.device;
  const int devices = cudaDevices();
  if (devices == 0) {
    throw Error(ErrorCode::no_device,
                "no CUDA device answers; check the driver with nvidia-smi or use the CPU backend");
  }
  if (device >= devices) {
    throw Error(ErrorCode::no_device, "there is no CUDA device " + std::to_string(device) + "; there are " +
                                          std::to_string(devices) + ", from 0 on");
  }
  if (device != kAllDevices || devices == 1)
    return std::make_unique<CudaBackend>(workers, options, device == kAllDevices ? 0 : device);
  std::vector<std::unique_ptr<OneDevice>> all;
  for (int number = 0; number < devices; ++number)
    all.push_back(std::make_unique<CudaBackend>(workers, options, number));
  return splitOver(std::move(all));
}

}  // namespace innersphere
