// The seam between the query and the hardware that walks the grids.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/sums.hpp"
#include "innersphere/query.hpp"
#include "prepare.hpp"

namespace innersphere {

/// An overlapping pair of spheres of one query of a batch.
struct Hit {
  std::uint32_t query;
  std::uint32_t a;
  std::uint32_t b;
};

/// Hits in no particular order; `count` of `items` are valid, the rest is room for the next run.
struct Hits {
  std::vector<Hit> items;
  std::size_t count = 0;
};

class WalkBackend {
 public:
  virtual ~WalkBackend() = default;

  /// Sums over all overlapping pairs of each query, into sums[0 .. queries.size()). Want::touch gives only a
  /// pair count of 0 or 1. With Want::contacts and Want::pairs all pairs also go into `hits`, which grows
  /// where needed.
  virtual void run(const std::vector<PreparedQuery>& queries, Want want, std::vector<core::Sums>& sums,
                   Hits& hits) = 0;

  /// Of the last run, on a device that was asked to take its time [s].
  virtual double kernelTime() const { return 0; }
};

inline bool wantsHits(Want want) {
  return want == Want::contacts || want == Want::pairs;
}

}  // namespace innersphere
