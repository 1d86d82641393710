// Takes some neighbouring queries of a batch over the device and back.
#pragma once

#include <span>

#include "batch/backend.hpp"
#include "common/workers.hpp"
#include "cuda/kernels.hpp"
#include "cuda/memory.hpp"
#include "cuda/pair_sorter.hpp"
#include "cuda/resident.hpp"

namespace innersphere::device {

/// Runs a part of a batch. Keeps its memory from one run to the next. What goes to the device is one copy, or
/// for a single query the arguments of its launch; sums come home through memory of the host that the kernels
/// write to, so the host needs no copy and no call to the driver to have them.
class BatchPart {
 public:
  struct Range {
    std::size_t begin = 0, end = 0;
    std::size_t size() const { return end - begin; }
  };

  /// Returns where the part that begins with query `begin` should end: its memory is bounded.
  static std::size_t endOf(std::span<const PreparedQuery> queries, std::size_t begin);

  void start(const Device& device, std::span<const PreparedQuery> queries, Range range, Want want,
             Workers& workers);

  /// Tells a resident kernel to leave, so that nothing has to wait until it does.
  void dismiss();

  /// Returns how many poses of a sweep a part may have.
  static std::size_t mostPoses(const Sweep& sweep);
  /// Starts the poses of a range. The overlaps are at `overlaps` once they were collected.
  void startSweep(const Device& device, const Sweep& sweep, Range range, Overlap* overlaps);
  /// Waits for the poses and brings their overlaps home. Returns the first pose that is none.
  SweepFault collectSweep();
  /// Puts all poses into a stream of the user's, and waits for none of them. All arrays are reached from the
  /// device. Its faults stay until clearFault().
  void streamSweep(const Device& device, const Sweep& sweep, Overlap* overlaps);
  /// Returns the first pose that was none, once the stream is done.
  SweepFault fault() const;
  void clearFault();

  /// Moves on what the device is done with. Returns true if results() are there.
  bool advance();
  void wait();

  Range range() const { return range_; }
  const core::Totals* results() const { return results_.data(); }
  /// Returns the lists, where contacts or pairs are wanted.
  const PinnedLists& lists() const { return pair_sorter_.lists(); }
  double kernelTime() const { return kernel_time_; }

 private:
  enum class Stage { traversal, traversed, sorting, done };

  void begin(const Device& device, Range range, Want want);
  void launchSweep(const Device& device, const Sweep& sweep, Range range, Overlap* overlaps);
  void gather(std::span<const PreparedQuery> queries, Workers& workers);
  void launch();
  void ask(const PreparedQuery& query);
  Goal goal() const;
  void prepareSweep();
  template <typename T>
  const T* bring(const T* from, std::size_t count, PinnedArray<T>& pinned, DeviceArray<T>& on_device);
  /// Returns whether the part is one query, which goes to the device as an argument.
  bool isSingle() const { return !sweep_ && range_.size() == 1; }
  bool traversed() const;
  /// Whether the part's only query goes to a kernel that stays.
  bool isResident() const { return isSingle() && device_.resident_seconds > 0 && !wantsPairs(want_); }
  void takeResult();
  void sort();

  Device device_;
  Range range_;
  Want want_ = Want::wrench;
  Stage stage_ = Stage::done;
  Batch batch_{};
  unsigned most_clusters_ = 0;
  std::size_t most_tasks_ = 0;
  std::size_t found_ = 0;  ///< overlapping pairs
  double kernel_time_ = 0;
  Event start_, stop_;

  unsigned run_ = 0;
  bool clean_ = false;  ///< sums and counters of the device are zero
  PinnedArray<HostSignal> signal_;
  Resident resident_;
  PinnedArray<Query> queries_;
  PinnedArray<core::Totals> results_;
  const Sweep* sweep_ = nullptr;
  Overlap* overlaps_ = nullptr;  ///< where those of a sweep go
  bool overlaps_are_staged_ = false;
  PinnedArray<Overlap> staged_overlaps_;
  PinnedArray<double> pinned_poses_[2];
  DeviceArray<double> device_poses_[2];
  DeviceArray<Counters> counters_;
  DeviceArray<Query> device_queries_;
  DeviceArray<DeviceSums> sums_;
  DeviceArray<unsigned long long> tasks_;
  CudaPairSorter pair_sorter_;
};

}  // namespace innersphere::device
