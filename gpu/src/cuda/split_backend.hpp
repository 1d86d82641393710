// Splits work over several devices. They exchange nothing, and results have the same bits for any number.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

#include "batch/backend.hpp"

namespace innersphere {

/// This is the backend of one device, which can take part in the work of several.
class OneDevice : public QueryBackend {
 public:
  /// Takes parts of so many poses from `next` on until none is left, and returns the first pose that is none.
  virtual SweepFault sweepParts(const Sweep& sweep, std::size_t poses, std::atomic<std::size_t>& next,
                                Overlap* overlaps) = 0;
};

/// Returns a backend that uses all of them at once, each from a thread of its own. The poses of a sweep go to
/// whichever device is free; a batch is cut into as many runs of queries, with equal numbers of clusters.
std::unique_ptr<QueryBackend> splitOver(std::vector<std::unique_ptr<OneDevice>> devices);

}  // namespace innersphere
