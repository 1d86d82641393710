// Declares what the host launches.
#pragma once

#include "cuda/batch.hpp"

namespace innersphere::device {

/// Traverses a batch. `most_clusters` is the number of clusters of both bodies of any query, and `most_tasks`
/// that of the tasks of all.
void launchTraversal(Goal goal, const Batch& batch, unsigned most_clusters, std::size_t most_tasks,
                     unsigned processors, cudaStream_t stream);

/// Traverses one query, whose sums and counters are zero before and after.
void launchSingle(Goal goal, const Batch& batch, const Query& query, unsigned processors,
                  cudaStream_t stream);

/// Launches a kernel that answers the questions in a mailbox, from the run of `batch` on, until it should
/// leave. Its models have so many clusters. Sums and counters are two each.
void launchResident(Goal goal, const Batch& batch, const Mailbox& mailbox, unsigned clusters,
                    unsigned processors, cudaStream_t stream);

/// Makes the queries of a batch, one for each pose, in the memory of the device, where `poses` are, too.
void launchPreparation(const Batch& batch, Query* queries, const core::SweptPair& pair, const Grid* grid_a,
                       const Grid* grid_b, const Poses& poses, cudaStream_t stream);

}  // namespace innersphere::device
