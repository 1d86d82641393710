// Calls of the CUDA runtime in this program: a test counts them, or lets an allocation fail.
#pragma once

#include <cstddef>

namespace innersphere::test {

/// So far, of those that anything starts with: looking for a device, choosing one, streams, memory, copies.
std::size_t cudaCalls();

/// So far, of memory of a device and of the host's for it.
std::size_t cudaAllocations();

/// After `others` more the next one fails; and no other.
void failCudaAllocationAfter(std::size_t others);
void failNoCudaAllocation();

}  // namespace innersphere::test
