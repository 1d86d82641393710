#include "cuda/batch_part.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <iterator>

#include "cuda/device_grid.hpp"

namespace innersphere::device {

namespace {

constexpr std::size_t kGrain = 64;           ///< queries that one thread gathers
constexpr std::size_t kMostTasks = 1 << 19;  ///< of one part
constexpr std::size_t kFewPairs = 1 << 12;
static_assert(kMostQueries <= 1u << 24, "see packTask()");

std::size_t tasksOf(const PreparedQuery& query) {
  return (query.setup.clusters[0] + kTaskClusters - 1) / kTaskClusters +
         (query.setup.clusters[1] + kTaskClusters - 1) / kTaskClusters;
}

std::size_t tasksOf(const core::SweptPair& pair) {
  return (pair.a.grid.cluster_count + kTaskClusters - 1) / kTaskClusters +
         (pair.b.grid.cluster_count + kTaskClusters - 1) / kTaskClusters;
}

unsigned bitsOf(std::uint32_t count) {
  return static_cast<unsigned>(std::bit_width(count - 1));
}

/// The grids of neighbouring queries are often the same.
class Grids {
 public:
  explicit Grids(const Device& device) : device_(device) {}

  const Grid* of(const ModelGrid& grid, int side) {
    Known& known = known_[side];
    if (known.grid != &grid) known = {&grid, gridOnDevice(grid, device_.number, device_.stream).onDevice()};
    return known.copy;
  }

 private:
  struct Known {
    const ModelGrid* grid = nullptr;
    const Grid* copy = nullptr;
  };
  const Device& device_;
  Known known_[2];
};

Query makeQuery(const PreparedQuery& from, Grids& grids) {
  Query to{from.setup, {}};
  if (from.clusters() == 0) return to;
  to.grids[0] = grids.of(*from.grid_a, 0);
  to.grids[1] = grids.of(*from.grid_b, 1);
  return to;
}

}  // namespace

std::size_t BatchPart::endOf(std::span<const PreparedQuery> queries, std::size_t begin) {
  std::size_t tasks = 0, end = begin;
  unsigned bits_a = 0, bits_b = 0;
  for (; end < queries.size() && end - begin < kMostQueries; ++end) {
    tasks += tasksOf(queries[end]);
    bits_a = std::max(bits_a, bitsOf(queries[end].setup.a.count));
    bits_b = std::max(bits_b, bitsOf(queries[end].setup.b.count));
    const bool wide = (end - begin) >> (64 - bits_a - bits_b) != 0;  // for the keys of overlapping pairs
    if (end > begin && (tasks > kMostTasks || wide)) break;
  }
  return end;
}

void BatchPart::start(const Device& device, std::span<const PreparedQuery> queries, Range range, Want want,
                      Workers& workers) {
  begin(device, range, want);
  sweep_ = nullptr;
  batch_.overlaps = nullptr;
  most_clusters_ = 0;
  most_tasks_ = 0;
  batch_.bits_a = batch_.bits_b = 0;
  for (std::size_t q = range.begin; q < range.end; ++q) {
    const core::Setup& setup = queries[q].setup;
    most_clusters_ = std::max(most_clusters_, static_cast<unsigned>(queries[q].clusters()));
    most_tasks_ += tasksOf(queries[q]);
    batch_.bits_a = std::max(batch_.bits_a, bitsOf(setup.a.count));
    batch_.bits_b = std::max(batch_.bits_b, bitsOf(setup.b.count));
  }
  if (!isResident() || !resident_.isFor(queries[range.begin], goal())) dismiss();
  results_.reserve(range.size());
  gather(queries, workers);
  if (isResident() && most_clusters_ > 0) {
    ask(queries[range.begin]);
  } else {
    launch();
  }
}

void BatchPart::dismiss() {
  if (resident_.dismiss()) ++run_;
}

void BatchPart::ask(const PreparedQuery& query) {
  batch_.found_pairs = nullptr;
  batch_.signal = signal_.data();
  batch_.run = ++run_;
  resident_.ask(query, *queries_.data(), goal(), batch_, device_);
  stage_ = Stage::traversal;
}

Goal BatchPart::goal() const {
  return want_ == Want::touch ? Goal::touch : want_ == Want::volume ? Goal::volume : Goal::wrench;
}

void BatchPart::begin(const Device& device, Range range, Want want) {
  device_ = device;
  range_ = range;
  want_ = want;
  kernel_time_ = 0;
  if (signal_.capacity() > 0) return;
  signal_.reserve(1);
  *signal_.data() = {};  // no run has this number
}

std::size_t BatchPart::mostPoses(const Sweep& sweep) {
  return std::clamp<std::size_t>(kMostTasks / tasksOf(sweep.pair), 1, kMostQueries);
}

void BatchPart::startSweep(const Device& device, const Sweep& sweep, Range range, Overlap* overlaps) {
  clearFault();
  launchSweep(device, sweep, range, overlaps);
}

void BatchPart::streamSweep(const Device& device, const Sweep& sweep, Overlap* overlaps) {
  const std::size_t at_once = mostPoses(sweep);
  for (std::size_t first = 0; first < sweep.poses.count; first += at_once)
    launchSweep(device, sweep, {first, std::min(first + at_once, sweep.poses.count)}, overlaps);
}

void BatchPart::launchSweep(const Device& device, const Sweep& sweep, Range range, Overlap* overlaps) {
  dismiss();
  begin(device, range, sweep.want);
  batch_.first_pose = range.begin;
  sweep_ = &sweep;
  overlaps_ = overlaps + range.begin;
  most_clusters_ = static_cast<unsigned>(sweep.clusters());
  most_tasks_ = tasksOf(sweep.pair) * range.size();
  const MemoryOf memory = memoryOf(overlaps_);
  overlaps_are_staged_ = !memory.isReachedFrom(device_.number);
  if (overlaps_are_staged_) staged_overlaps_.reserve(range.size());
  batch_.overlaps = overlaps_are_staged_ ? staged_overlaps_.data() : static_cast<Overlap*>(memory.on_device);
  launch();
}

/// Returns the numbers in the memory of the device.
template <typename T>
const T* BatchPart::bring(const T* from, std::size_t count, PinnedArray<T>& pinned,
                          DeviceArray<T>& on_device) {
  const MemoryOf memory = memoryOf(from);
  if (memory.isReachedFrom(device_.number)) return static_cast<const T*>(memory.on_device);
  on_device.reserve(count);
  if (!memory.on_device) {
    pinned.reserve(count);
    std::copy(from, from + count, pinned.data());
    from = pinned.data();
  }
  copyAsync(on_device.data(), from, count, device_.stream);
  return on_device.data();
}

void BatchPart::prepareSweep() {
  const std::size_t first = range_.begin, count = range_.size();
  Poses poses = sweep_->poses;
  poses.count = count;
  const auto part = [&](const double*& numbers, std::size_t width, int array) {
    numbers = bring(numbers + width * first, width * count, pinned_poses_[array], device_poses_[array]);
  };
  if (poses.matrices) {
    part(poses.matrices, 16, 0);
  } else {
    part(poses.positions, 3, 0);
    part(poses.quaternions, 4, 1);
  }
  Grids grids(device_);
  launchPreparation(batch_, device_queries_.data(), sweep_->pair, grids.of(*sweep_->grid_a, 0),
                    grids.of(*sweep_->grid_b, 1), poses, device_.stream);
}

SweepFault BatchPart::collectSweep() {
  wait();
  if (const SweepFault first = fault(); first.fault != core::Fault::none) return first;
  if (!overlaps_are_staged_) return {};
  const std::size_t bytes = range_.size() * sizeof(Overlap);
  if (memoryOf(overlaps_).on_device) {  // of another device
    INNERSPHERE_CUDA(cudaMemcpy(overlaps_, staged_overlaps_.data(), bytes, cudaMemcpyDefault));
  } else {
    std::memcpy(static_cast<void*>(overlaps_), staged_overlaps_.data(), bytes);
  }
  return {};
}

SweepFault BatchPart::fault() const {
  const HostSignal& signal = *signal_.data();
  if (signal.fault == 0) return {};
  return {signal.in_poses + poseOf(signal.fault), faultOf(signal.fault)};
}

void BatchPart::clearFault() {
  if (signal_.capacity() > 0) signal_.data()->fault = 0;
}

void BatchPart::gather(std::span<const PreparedQuery> queries, Workers& workers) {
  queries_.reserve(range_.size());
  workers.forRanges(range_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    const CurrentDevice current(device_.number);
    Grids grids(device_);
    for (std::size_t q = begin; q < end; ++q)
      queries_.data()[q] = makeQuery(queries[range_.begin + q], grids);
  });
}

void BatchPart::launch() {
  const std::size_t count = range_.size();
  const bool single = isSingle();
  batch_.count = static_cast<unsigned>(count);
  if (most_clusters_ == 0) {
    std::fill_n(results_.data(), count, core::Totals{});
    found_ = 0;
    stage_ = Stage::traversed;
    return;
  }
  const std::size_t sums = std::max<std::size_t>(count, kSumCopies);
  if (counters_.capacity() < 1 || sums_.capacity() < sums) clean_ = false;
  counters_.reserve(1);
  sums_.reserve(sums);
  if (!single || !clean_) {
    INNERSPHERE_CUDA(cudaMemsetAsync(counters_.data(), 0, sizeof(Counters), device_.stream));
    INNERSPHERE_CUDA(cudaMemsetAsync(sums_.data(), 0, kSumCopies * sizeof(DeviceSums), device_.stream));
  }
  clean_ = false;
  if (!single) {
    tasks_.reserve(most_tasks_);
    if (device_queries_.capacity() < count) {
      device_queries_.reserve(count);  // kernels copy queries as a whole, with their gaps
      INNERSPHERE_CUDA(cudaMemsetAsync(device_queries_.data(), 0, count * sizeof(Query), device_.stream));
    }
  }
  batch_.queries = single ? nullptr : device_queries_.data();
  batch_.sums = sums_.data();
  batch_.counters = counters_.data();
  if (sweep_) {
    prepareSweep();
  } else if (!single) {
    copyAsync(device_queries_.data(), queries_.data(), count, device_.stream);
  }
  batch_.tasks = tasks_.data();
  if (wantsPairs(want_)) pair_sorter_.reserve(kFewPairs);
  batch_.found_pairs = wantsPairs(want_) ? pair_sorter_.keys() : nullptr;
  batch_.capacity = pair_sorter_.capacity();
  batch_.results = results_.data();
  batch_.signal = signal_.data();
  batch_.run = ++run_;
  if (device_.time_kernels) INNERSPHERE_CUDA(cudaEventRecord(start_.get(), device_.stream));
  if (single) {
    launchSingle(goal(), batch_, *queries_.data(), device_.processors, device_.stream);
  } else {
    launchTraversal(goal(), batch_, most_clusters_, most_tasks_, device_.processors, device_.stream);
  }
  if (device_.time_kernels) INNERSPHERE_CUDA(cudaEventRecord(stop_.get(), device_.stream));
  stage_ = Stage::traversal;
}

/// Whether the kernels told the host that they are done.
bool BatchPart::traversed() const {
  const volatile HostSignal& signal = *signal_.data();
  if (!isSingle()) return signal.done == run_;
  return std::all_of(std::begin(signal.halves), std::end(signal.halves),
                     [&](unsigned long long half) { return half >> 32 == run_; });
}

void BatchPart::takeResult() {
  std::atomic_thread_fence(std::memory_order_acquire);
  const HostSignal& signal = *signal_.data();
  found_ = signal.found;
  if (!isSingle()) return;
  unsigned long long words[kResultWords + 1];
  for (std::size_t i = 0; i <= kResultWords; ++i)
    words[i] = (signal.halves[2 * i] & 0xffffffffu) | signal.halves[2 * i + 1] << 32;
  std::memcpy(results_.data(), words, sizeof(core::Totals));
  found_ = words[kResultWords];
  if (!isResident()) clean_ = true;
}

bool BatchPart::advance() {
  if (stage_ == Stage::done) return true;
  if (stage_ == Stage::traversal) {
    if (!traversed()) {
      const cudaError_t status = cudaStreamQuery(device_.stream);  // the driver knows if the kernels failed
      if (status != cudaErrorNotReady) INNERSPHERE_CUDA(status);
      if (!traversed()) {
        if (status == cudaSuccess && isResident()) resident_.launch(device_);  // it left without an answer
        return false;
      }
    }
    takeResult();
    if (device_.time_kernels) {
      INNERSPHERE_CUDA(cudaEventSynchronize(stop_.get()));
      kernel_time_ += secondsBetween(start_, stop_);
    }
    stage_ = Stage::traversed;
  }
  if (stage_ == Stage::traversed) {
    stage_ = Stage::done;
    if (!wantsPairs(want_)) return true;
    sort();
    return false;
  }
  const cudaError_t status = cudaStreamQuery(device_.stream);
  if (status == cudaErrorNotReady) return false;
  INNERSPHERE_CUDA(status);
  stage_ = Stage::done;
  return true;
}

void BatchPart::wait() {
  constexpr int kSpins = 10000;  // some 10 us, before the driver is asked
  do {
    for (int spin = 0; stage_ == Stage::traversal && !traversed() && spin < kSpins; ++spin) continue;
  } while (!advance());
}

void BatchPart::sort() {
  if (found_ > pair_sorter_.capacity()) {  // now what is needed is known
    pair_sorter_.reserve(found_ + found_ / 8);
    launch();
    return;
  }
  pair_sorter_.start(batch_, *queries_.data(), found_, want_, device_.stream);
  stage_ = Stage::sorting;
}

}  // namespace innersphere::device
