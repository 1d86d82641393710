// Answers queries with Estimator::surface, after the spheres have said where to look.
#pragma once

#include <cstddef>
#include <vector>

#include "common/workers.hpp"
#include "innersphere/query.hpp"

namespace innersphere {

/// Returns the radii with which the spheres are asked.
inline Estimator estimatorOfSpheres(const QueryOptions& options) {
  return options.estimator == Estimator::raw ? Estimator::raw : Estimator::volume_true;
}

/// Returns what the spheres are asked for: with Estimator::surface always the direction of the contact.
inline Want wantOfSpheres(const QueryOptions& options) {
  return options.estimator == Estimator::surface && options.want == Want::volume ? Want::wrench
                                                                                 : options.want;
}

/// Holds a batch from its start to its end, if it is one for surfaces.
class SurfaceQueries {
 public:
  /// Keeps the queries, whose placements have been checked. Throws Error for what has no closed surface, and
  /// for a margin.
  void keep(const PairQuery* queries, std::size_t count, const QueryOptions& options);

  /// Replaces what the spheres said of the volume by what the surfaces say.
  void refine(Workers& workers, std::vector<Overlap>& overlaps) const;

 private:
  std::vector<PairQuery> queries_;  ///< none if the batch is not for surfaces
  bool volume_only_ = false;
};

}  // namespace innersphere
