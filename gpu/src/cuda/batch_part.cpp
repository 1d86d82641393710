#include "cuda/batch_part.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <iterator>

#include "batch/backend.hpp"
#include "cuda/device_grid.hpp"

namespace innersphere::device {

namespace {

constexpr std::size_t kGrain = 64;           ///< queries that one thread gathers
constexpr std::size_t kMostTasks = 1 << 19;  ///< of one part
constexpr std::size_t kFewPairs = 1 << 12;
static_assert(kMostQueries <= 1u << 24, "see packTask()");

std::size_t tasksOf(const PreparedQuery& query) {
  return (query.setup.a.clusters + kTaskClusters - 1) / kTaskClusters +
         (query.setup.b.clusters + kTaskClusters - 1) / kTaskClusters;
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
  const core::Setup& setup = from.setup;
  Query to{setup.frame, {setup.a_in_b, setup.b_in_a}, setup.units, {setup.a.clusters, setup.b.clusters}, {}};
  if (from.clusters() == 0) return to;
  to.grids[0] = grids.of(*from.grid_a, 0);
  to.grids[1] = grids.of(*from.grid_b, 1);
  return to;
}

}  // namespace

std::size_t BatchPart::endOf(const std::vector<PreparedQuery>& queries, std::size_t begin) {
  std::size_t tasks = 0, end = begin;
  unsigned bits_a = 0, bits_b = 0;
  for (; end < queries.size() && end - begin < kMostQueries; ++end) {
    tasks += tasksOf(queries[end]);
    bits_a = std::max(bits_a, bitsOf(queries[end].setup.a.grid.count));
    bits_b = std::max(bits_b, bitsOf(queries[end].setup.b.grid.count));
    const bool wide = (end - begin) >> (64 - bits_a - bits_b) != 0;  // for the keys of overlapping pairs
    if (end > begin && (tasks > kMostTasks || wide)) break;
  }
  return end;
}

void BatchPart::start(const Device& device, const std::vector<PreparedQuery>& queries, Range range, Want want,
                      Workers& workers) {
  device_ = device;
  range_ = range;
  want_ = want;
  kernel_time_ = 0;
  most_clusters_ = 0;
  most_tasks_ = 0;
  batch_.bits_a = batch_.bits_b = 0;
  for (std::size_t q = range.begin; q < range.end; ++q) {
    const core::Setup& setup = queries[q].setup;
    most_clusters_ = std::max(most_clusters_, static_cast<unsigned>(queries[q].clusters()));
    most_tasks_ += tasksOf(queries[q]);
    batch_.bits_a = std::max(batch_.bits_a, bitsOf(setup.a.grid.count));
    batch_.bits_b = std::max(batch_.bits_b, bitsOf(setup.b.grid.count));
  }
  results_.reserve(range.size());
  if (signal_.capacity() == 0) {
    signal_.reserve(1);
    *signal_.data() = {};  // no run has this number
  }
  gather(queries, workers);
  launch();
}

void BatchPart::gather(const std::vector<PreparedQuery>& queries, Workers& workers) {
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
  const bool single = count == 1;
  batch_.count = static_cast<unsigned>(count);
  if (most_clusters_ == 0) {
    std::fill_n(results_.data(), count, core::Totals{});
    found_ = 0;
    stage_ = Stage::traversed;
    return;
  }
  if (counters_.capacity() < 1 || sums_.capacity() < count) clean_ = false;
  counters_.reserve(1);
  sums_.reserve(count);
  if (!single || !clean_) {
    INNERSPHERE_CUDA(cudaMemsetAsync(counters_.data(), 0, sizeof(Counters), device_.stream));
    INNERSPHERE_CUDA(cudaMemsetAsync(sums_.data(), 0, sizeof(DeviceSums), device_.stream));
  }
  clean_ = false;
  if (!single) {
    tasks_.reserve(most_tasks_);
    device_queries_.reserve(count);
    copyAsync(device_queries_.data(), queries_.data(), count, device_.stream);
  }
  batch_.queries = single ? nullptr : device_queries_.data();
  batch_.sums = sums_.data();
  batch_.counters = counters_.data();
  batch_.tasks = tasks_.data();
  if (wantsPairs(want_)) pair_sorter_.reserve(kFewPairs);
  batch_.found_pairs = wantsPairs(want_) ? pair_sorter_.keys() : nullptr;
  batch_.capacity = pair_sorter_.capacity();
  batch_.results = results_.data();
  batch_.signal = signal_.data();
  batch_.run = ++run_;
  const Goal goal = want_ == Want::touch ? Goal::touch : want_ == Want::volume ? Goal::volume : Goal::wrench;
  if (device_.time_kernels) INNERSPHERE_CUDA(cudaEventRecord(start_.get(), device_.stream));
  launchTraversal(goal, batch_, single ? queries_.data() : nullptr, most_clusters_, most_tasks_,
                  device_.processors, device_.stream);
  if (device_.time_kernels) INNERSPHERE_CUDA(cudaEventRecord(stop_.get(), device_.stream));
  stage_ = Stage::traversal;
}

/// Whether the kernels told the host that they are done.
bool BatchPart::traversed() const {
  const volatile HostSignal& signal = *signal_.data();
  if (range_.size() > 1) return signal.done == run_;
  return std::all_of(std::begin(signal.halves), std::end(signal.halves),
                     [&](unsigned long long half) { return half >> 32 == run_; });
}

void BatchPart::takeResult() {
  std::atomic_thread_fence(std::memory_order_acquire);
  const HostSignal& signal = *signal_.data();
  found_ = signal.found;
  if (range_.size() > 1) return;
  unsigned long long words[kResultWords + 1];
  for (std::size_t i = 0; i <= kResultWords; ++i)
    words[i] = (signal.halves[2 * i] & 0xffffffffu) | signal.halves[2 * i + 1] << 32;
  std::memcpy(results_.data(), words, sizeof(core::Totals));
  found_ = words[kResultWords];
  clean_ = true;
}

bool BatchPart::advance() {
  if (stage_ == Stage::done) return true;
  if (stage_ == Stage::traversal) {
    if (!traversed()) {
      const cudaError_t status = cudaStreamQuery(device_.stream);  // the driver knows if the kernels failed
      if (status != cudaErrorNotReady) INNERSPHERE_CUDA(status);
      if (!traversed()) return false;
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
