// Runs overlap queries within a limit of time or work, and says how exact overlaps are.
#pragma once

#include <cstdint>
#include <vector>

#include "innersphere/query.hpp"

namespace innersphere {

/// Says what a query may cost. If both limits are set, both hold.
struct QueryBudget {
  /// The time by the caller's clock [s]. 0: no limit. It is predicted from earlier queries and may be
  /// exceeded.
  double seconds = 0;
  /// The number of spheres of both bodies together, to which the work is proportional. 0: no limit.
  std::uint64_t spheres = 0;
};

/// Holds the result of a query within a budget.
struct BoundedOverlap {
  Overlap overlap;             ///< The sums.
  std::uint32_t prefix_a = 0;  ///< The number of spheres of A that were used.
  std::uint32_t prefix_b = 0;  ///< The number of spheres of B that were used.
  double error = 0;        ///< The expected error of the volume: ExpectedError::mean. See expectedError().
  double error_bound = 0;  ///< What it exceeds in 1 of 20 cases: ExpectedError::bound.
};

/// Returns how far off the volume is to be expected that a query has found, from what was measured for
/// overlaps of this depth when the packings were made (see Packing::overlap_errors), from A and from B.
/// Theirs are independent: the logarithms of found over true have half the variance of each. That takes area,
/// stiffness and energy: NaN without area and energy, as Want::volume gives none. NaN also if nothing
/// overlaps, nothing was measured, or nothing so shallow, and with volume-true radii from kDeepOverlap of
/// both bodies on if one packing is of a file that knows no errors there. With Estimator::surface 0, but NaN
/// if the triangles of a packing enclose another volume than its solid has, by more than 1e-3 of it: shells
/// that overlap enclose a part twice, chords of a curve leave one out. Margins and CollisionModel::update()
/// are not considered. Throws Error bad_argument for a null model.
ExpectedError expectedError(const PairQuery& query, Estimator estimator, const Overlap& found);

/// Runs single queries with the longest prefixes that a budget allows. Both bodies use 64, 128, 256, ...
/// spheres, up to all they have. The time of such a step is predicted from the slowest of the last few
/// queries and from the measured ratios of the steps. The prediction holds as long as bodies move little from
/// one query to the next. Use one object for each pair of bodies.
class BoundedQuery {
 public:
  /// Makes an object that knows nothing of times yet. The context must outlive it.
  explicit BoundedQuery(QueryContext& context) : context_(context) {}

  /// Runs the query with each step, which builds all grids and compares the steps. Give it a pose where the
  /// bodies overlap. Without a warm-up each step counts as twice as slow as the one before until it was
  /// tried, and the first query with a step also builds its grids. Throws as QueryContext::run().
  void warmUp(const PairQuery& query, const QueryOptions& options = {});

  /// Runs the query with the longest step that the budget allows, and with the shortest one in any case. The
  /// prefixes of the query are upper bounds. Without a warm-up the first query with a limit of time takes the
  /// shortest step. Throws as QueryContext::run(), and bad_argument for seconds that are negative or not a
  /// number.
  BoundedOverlap overlap(const PairQuery& query, const QueryBudget& budget, const QueryOptions& options = {});

 private:
  struct Run {
    std::size_t step = 0;
    double seconds = 0;
  };

  std::size_t longestStep(const PairQuery& query, const QueryBudget& budget) const;
  double predicted(std::size_t step) const;
  Overlap timedRun(const PairQuery& query, const QueryOptions& options, std::size_t step);
  void learnGrowth(const Run& before, const Run& now);

  QueryContext& context_;
  std::vector<double> growth_;  ///< The time of each step over that of the one before. 0: never used.
  std::vector<Run> recent_;     ///< The last few queries, the newest last.
};

}  // namespace innersphere
