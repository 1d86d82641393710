// Checks a query and brings it into the form that the backends read.
#pragma once

#include <cstddef>

#include "core/setup.hpp"
#include "hash_grid.hpp"
#include "innersphere/query.hpp"

namespace innersphere {

struct PreparedQuery {
  core::Setup setup;  ///< with the grids in the memory of the CPU
  const HashGrid* grid_a;
  const HashGrid* grid_b;

  std::size_t clusters() const { return std::size_t{setup.a.clusters} + setup.b.clusters; }
};

/// Throws Error as QueryContext::run says; `index` is the query's place in its batch, for messages. Bodies
/// whose bounding balls or boxes are apart get no clusters to walk. Builds the grids if this is their first
/// use.
PreparedQuery prepare(const PairQuery& query, std::size_t index, Estimator estimator);

}  // namespace innersphere
