#include "cuda_calls.hpp"

#include <cuda_runtime.h>

#include <atomic>
#include <limits>

namespace {

constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();
std::atomic<std::size_t> calls{0};         ///< but for allocations
std::atomic<std::size_t> count{0};         ///< of allocations
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

cudaError_t __real_cudaGetDeviceCount(int* number);
cudaError_t __real_cudaGetDevice(int* device);
cudaError_t __real_cudaSetDevice(int device);
cudaError_t __real_cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned flags);
cudaError_t __real_cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind,
                                   cudaStream_t stream);

cudaError_t __wrap_cudaGetDeviceCount(int* number) {
  ++calls;
  return __real_cudaGetDeviceCount(number);
}
cudaError_t __wrap_cudaGetDevice(int* device) {
  ++calls;
  return __real_cudaGetDevice(device);
}
cudaError_t __wrap_cudaSetDevice(int device) {
  ++calls;
  return __real_cudaSetDevice(device);
}
cudaError_t __wrap_cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned flags) {
  ++calls;
  return __real_cudaStreamCreateWithFlags(stream, flags);
}
cudaError_t __wrap_cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind,
                                   cudaStream_t stream) {
  ++calls;
  return __real_cudaMemcpyAsync(to, from, bytes, kind, stream);
}
}

namespace innersphere::test {

std::size_t cudaCalls() {
  return calls + count;
}

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
