// Checks a query and brings it into the form that the backends read.
#pragma once

#include <cstddef>
#include <string>

#include "core/pair_setup.hpp"
#include "grid/model_grid.hpp"
#include "innersphere/query.hpp"

namespace innersphere {

/// Holds a query that was checked, with the grids of both bodies.
struct PreparedQuery {
  core::Setup setup;  ///< Its grids have no arrays; see bringToCpu().
  const ModelGrid* grid_a;
  const ModelGrid* grid_b;

  std::size_t clusters() const { return std::size_t{setup.clusters[0]} + setup.clusters[1]; }
};

/// Remembers the last grids. The grids of neighbouring queries are often the same and are then found without
/// the model's lock. Each thread needs an object of its own.
class KnownGrids {
 public:
  const ModelGrid& of(const CollisionModel& model, std::uint32_t prefix, Estimator estimator, int side);

 private:
  struct Known {
    const CollisionModel* model = nullptr;
    std::uint32_t prefix = 0;
    const ModelGrid* grid = nullptr;
  };
  Known known_[2];
};

/// Checks a query and returns it in the form that the backends read. Throws Error as QueryContext::run()
/// says; `index` is the query's place in its batch, for messages. Bodies whose bounding balls or boxes are
/// apart get no clusters to traverse. Builds no grids. All calls with the same `grids` have one estimator.
PreparedQuery prepare(const PairQuery& query, std::size_t index, Estimator estimator, KnownGrids& grids);

/// Throws what prepare() throws for such a fault of the body `name` in query `index`.
[[noreturn]] void failFor(core::Fault fault, std::size_t index, const std::string& name);

/// Builds the grids of a query on the CPU if this is their first use there.
void bringToCpu(PreparedQuery& query);

}  // namespace innersphere
