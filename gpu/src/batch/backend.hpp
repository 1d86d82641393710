// Declares the seam between the query and the hardware that it runs on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "batch/prepare.hpp"
#include "core/sums.hpp"
#include "innersphere/query.hpp"

namespace innersphere {

/// Runs one batch after the other.
class QueryBackend {
 public:
  virtual ~QueryBackend() = default;

  /// Begins a batch. `queries` must live until finish().
  virtual void start(const std::vector<PreparedQuery>& queries, Want want) = 0;

  /// Returns true if finish() need not wait. Throws what finish() would.
  virtual bool ready() = 0;

  /// Waits for the batch. Leaves `result` as it was where it throws; the next batch may begin in either case.
  virtual void finish(QueryResult& result) = 0;

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
