// Keeps a kernel on the device that answers single queries, so that none has to be launched for each.
#pragma once

#include "batch/backend.hpp"
#include "cuda/kernels.hpp"
#include "cuda/memory.hpp"

namespace innersphere::device {

/// Says where queries run.
struct Device {
  int number = 0;
  unsigned processors = 1;
  cudaStream_t stream = nullptr;
  bool time_kernels = false;
  double resident_seconds = 0;  ///< how long a kernel waits for the next single query; 0: there is none
};

/// Runs a kernel for queries of two models. It leaves by itself when no question comes for long, and a new
/// one is then launched for the next.
class Resident {
 public:
  /// Returns true if the kernel that was launched last is one for such queries, and for these spheres.
  bool isFor(const PreparedQuery& query, Goal goal) const;

  /// Asks for a query; the answer comes as that of a launch, with the run of `batch`.
  void ask(const PreparedQuery& prepared, const Query& query, Goal goal, const Batch& batch,
           const Device& device);

  /// Launches a kernel for the question that was asked last, which the one before left without an answer.
  void launch(const Device& device);

  /// Tells the kernel to leave. That takes the run after the last question's; false if there is none.
  bool dismiss();

 private:
  void write(unsigned run, unsigned command, const Query* query);

  const ModelGrid* models_[2] = {};
  std::uint64_t versions_[2] = {};
  Goal goal_ = Goal::touch;
  bool launched_ = false;
  unsigned clusters_ = 0;
  Batch batch_{};
  Mailbox mailbox_{};
  PinnedArray<unsigned long long> questions_;  ///< two, which take turns
  unsigned long long* question_ = nullptr;     ///< of the kernel that was launched last
  DeviceArray<unsigned long long> relay_;
  DeviceArray<DeviceSums> sums_;
  DeviceArray<Counters> counters_;
};

}  // namespace innersphere::device
