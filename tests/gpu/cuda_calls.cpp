#include "cuda_calls.hpp"

#include <cuda_runtime.h>

#include <atomic>
#include <limits>

namespace {

constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();
std::atomic<std::size_t> count{0};
std::atomic<std::size_t> failing{kNever};  ///< the number of the allocation that does

bool fails() {
  return count++ == failing;
}

}  // namespace

// The linker sends all calls here (--wrap).
extern "C" {
cudaError_t __real_cudaMalloc(void** p, std::size_t bytes);
cudaError_t __real_cudaMallocHost(void** p, std::size_t bytes);

cudaError_t __wrap_cudaMalloc(void** p, std::size_t bytes) {
  return fails() ? cudaErrorMemoryAllocation : __real_cudaMalloc(p, bytes);
}
cudaError_t __wrap_cudaMallocHost(void** p, std::size_t bytes) {
  return fails() ? cudaErrorMemoryAllocation : __real_cudaMallocHost(p, bytes);
}
}

namespace innersphere::test {

std::size_t cudaAllocations() {
  return count;
}

void failCudaAllocationAfter(std::size_t others) {
  failing = count + others;
}
void failNoCudaAllocation() {
  failing = kNever;
}

}  // namespace innersphere::test
