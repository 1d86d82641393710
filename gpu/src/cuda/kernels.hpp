// Declares what the host launches.
#pragma once

#include "cuda/batch.hpp"

namespace innersphere::device {

/// Traverses a batch, or a `single` query. `most_clusters` is the number of clusters of both bodies of any
/// query, and `most_tasks` that of the tasks of all.
void launchTraversal(Goal goal, const Batch& batch, const Query* single, unsigned most_clusters,
                     std::size_t most_tasks, unsigned processors, cudaStream_t stream);

/// Makes the queries of a batch, one for each pose, in the memory of the device, where `poses` are, too.
void launchPreparation(const Batch& batch, Query* queries, const core::SweptPair& pair, const Grid* grid_a,
                       const Grid* grid_b, const Poses& poses, cudaStream_t stream);

}  // namespace innersphere::device
