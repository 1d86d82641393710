// Declares what the host launches.
#pragma once

#include "cuda/batch.hpp"

namespace innersphere::device {

/// Traverses a batch, or a `single` query. `most_clusters` is the number of clusters of both bodies of any
/// query, and `most_tasks` that of the tasks of all.
void launchTraversal(Goal goal, const Batch& batch, const Query* single, unsigned most_clusters,
                     std::size_t most_tasks, unsigned processors, cudaStream_t stream);

}  // namespace innersphere::device
