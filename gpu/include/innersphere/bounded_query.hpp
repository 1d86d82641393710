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

struct BoundedOverlap {
  Overlap overlap;
  std::uint32_t prefix_a = 0;  ///< spheres that were used
  std::uint32_t prefix_b = 0;
  /// Expected |relative error| of the volume: what was measured when the worse of the two packings was made,
  /// for overlaps that are as deep (see Packing::overlap_errors). NaN if nothing overlaps or was measured.
  double error = 0;
};

/// Runs single queries with the longest prefixes that a budget allows. Both bodies use 64, 128, 256, ...
/// spheres, up to all they have. How long each step takes is learnt from the queries that used it: a step
/// that was too slow is tried again only after a while. Use one for each kind of pair.
class BoundedQuery {
 public:
  /// The context must outlive this.
  explicit BoundedQuery(QueryContext& context) : context_(context) {}

  /// Runs the query once with each step, so that all grids are there and their times are known. Without it
  /// the first query with a step also builds its grids, and counts as slow as that.
  void warmUp(const PairQuery& query, const QueryOptions& options = {});

  /// At least the shortest step, whatever the budget. Prefixes of the query are upper bounds. Throws as
  /// QueryContext::run; bad_argument for seconds that are negative or not a number.
  BoundedOverlap overlap(const PairQuery& query, const QueryBudget& budget, const QueryOptions& options = {});

 private:
  std::size_t longestStep(const PairQuery& query, const QueryBudget& budget) const;
  Overlap timedRun(const PairQuery& query, const QueryOptions& options, std::size_t step);

  QueryContext& context_;
  std::vector<double> seconds_;  ///< of each step, the worst of late; negative: not known
};

}  // namespace innersphere
