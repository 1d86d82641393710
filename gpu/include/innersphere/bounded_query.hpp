// Overlap queries that keep to a time or to an amount of work, and say how exact they are.
#pragma once

#include <cstdint>
#include <vector>

#include "innersphere/query.hpp"

namespace innersphere {

/// What a query may cost. Where both are given both hold.
struct QueryBudget {
  double seconds = 0;  ///< as the caller's clock sees it; 0: any. Kept as well as earlier queries foretell it
  std::uint64_t spheres = 0;  ///< of both bodies together; 0: any. The work is proportional to them
};

/// What a query within a budget returns.
struct BoundedOverlap {
  Overlap overlap;             ///< the sums
  std::uint32_t prefix_a = 0;  ///< spheres of A that were used
  std::uint32_t prefix_b = 0;  ///< spheres of B that were used
  /// Expected |relative error| of the volume: what was measured when the worse of the two packings was made,
  /// for overlaps that are as deep (see Packing::overlap_errors). NaN if nothing overlaps or was measured.
  double error = 0;
};

/// Runs single queries with the longest prefixes that a budget allows. Both bodies use 64, 128, 256, ...
/// spheres, up to all they have. What a step will take is foretold from the slowest of the last few queries
/// and from how the steps were seen to compare, so it is right as long as bodies move little from one query
/// to the next. Use one for each pair of bodies.
class BoundedQuery {
 public:
  /// The context must outlive this.
  explicit BoundedQuery(QueryContext& context) : context_(context) {}

  /// Runs the query with each step, so that all grids are there and the steps are compared: give it a pose
  /// where the bodies overlap. Without it each step is taken to be twice as slow as the one before until it
  /// was tried, and the first query with a step also builds its grids.
  void warmUp(const PairQuery& query, const QueryOptions& options = {});

  /// At least the shortest step, whatever the budget. Prefixes of the query are upper bounds. Throws as
  /// QueryContext::run; bad_argument for seconds that are negative or not a number.
  BoundedOverlap overlap(const PairQuery& query, const QueryBudget& budget, const QueryOptions& options = {});

 private:
  struct Run {
    std::size_t step = 0;
    double seconds = 0;
  };

  std::size_t longestStep(const PairQuery& query, const QueryBudget& budget) const;
  double foretold(std::size_t step) const;
  Overlap timedRun(const PairQuery& query, const QueryOptions& options, std::size_t step);
  void learnGrowth(const Run& before, const Run& now);

  QueryContext& context_;
  std::vector<double> growth_;  ///< how many times slower each step is than the one before; 0: never used
  std::vector<Run> recent_;     ///< the last few queries, the newest last
};

}  // namespace innersphere
