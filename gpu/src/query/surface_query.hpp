// Answers queries with Estimator::surface.
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

/// Returns whether the triangles answer all that is wanted.
inline bool needsNoSpheres(const QueryOptions& options) {
  return options.estimator == Estimator::surface &&
         (options.want == Want::volume || options.want == Want::wrench);
}

/// Holds a batch from its start to its end, if it is one for surfaces.
class SurfaceQueries {
 public:
  /// Keeps the queries, whose placements have been checked. Throws Error for what has no closed surface, and
  /// for a margin.
  void keep(const PairQuery* queries, std::size_t count, const QueryOptions& options);

  /// Puts what the surfaces say in the place of what the spheres said.
  void refine(Workers& workers, std::vector<Overlap>& overlaps) const;

 private:
  std::vector<PairQuery> queries_;  ///< none if the batch is not for surfaces
  bool volume_only_ = false;
};

}  // namespace innersphere
