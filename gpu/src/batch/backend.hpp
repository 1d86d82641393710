// Declares the seam between the query and the hardware that it runs on.
#pragma once

#include <cstddef>
#include <limits>
#include <span>

#include "batch/prepare.hpp"
#include "core/poses.hpp"
#include "core/sums.hpp"
#include "innersphere/error.hpp"
#include "innersphere/query.hpp"

namespace innersphere {

/// Says what is computed for two bodies of which one is brought to many poses.
struct Sweep {
  core::SweptPair pair;
  const ModelGrid* grid_a;
  const ModelGrid* grid_b;
  Poses poses;
  Want want;

  /// Returns how many clusters of both bodies may have to be traversed at a pose.
  std::size_t clusters() const { return std::size_t{pair.a.grid.cluster_count} + pair.b.grid.cluster_count; }
};

/// Says which pose of a sweep is none, and why. Of two, the one with the lesser number counts.
struct SweepFault {
  std::size_t number = std::numeric_limits<std::size_t>::max();
  core::Fault fault = core::Fault::none;

  void take(const SweepFault& other) {
    if (other.fault != core::Fault::none && other.number < number) *this = other;
  }
  void throwIfAny() const {
    if (fault != core::Fault::none) failFor(fault, number, "B");
  }
};

/// Runs one batch after the other.
class QueryBackend {
 public:
  virtual ~QueryBackend() = default;

  /// Begins a batch. `queries` must live until finish().
  virtual void start(std::span<const PreparedQuery> queries, Want want) = 0;

  /// Returns true if finish() need not wait. Throws what finish() would.
  virtual bool ready() = 0;

  /// Waits for the batch. Leaves `result` as it was where it throws; the next batch may begin in either case.
  virtual void finish(QueryResult& result) = 0;

  /// Writes the overlap at each pose. Throws Error for the first pose that is none, by number, and then
  /// leaves some overlaps written and others not.
  virtual void sweep(const Sweep& sweep, Overlap* overlaps) = 0;

  /// Begins a sweep in a stream of the user's, after those that are in it already. Null for the CPU, where
  /// this is sweep().
  virtual void startSweep(const Sweep& sweep, Overlap* overlaps, void* stream) {
    if (stream)
      throw Error(ErrorCode::bad_argument,
                  "a sweep in a stream needs one device: neither the CPU nor several");
    this->sweep(sweep, overlaps);
  }
  /// Waits for the sweeps that were begun. Throws as sweep() does.
  virtual void finishSweeps() {}

  /// Returns the time that a device worked on the last batch [s]; 0 if it is not measured.
  virtual double kernelTime() const { return 0; }
};

inline bool wantsContacts(Want want) {
  return want == Want::contacts_of_a || want == Want::contacts;
}

inline bool wantsPairs(Want want) {
  return wantsContacts(want) || want == Want::pairs;
}

}  // namespace innersphere
