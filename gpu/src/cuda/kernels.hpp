// What the host launches.
#pragma once

#include "cuda/batch.hpp"

namespace innersphere::device {

/// Walks a batch, or a `single` query. `most_clusters`: of both bodies of any query; `most_items`: of all.
void launchWalk(Goal goal, const Batch& batch, const Query* single, unsigned most_clusters,
                std::size_t most_items, unsigned processors, cudaStream_t stream);

}  // namespace innersphere::device
