// Declares CUDA calls that throw, and memory of the device that frees itself.
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <cstring>
#include <string>

#include "innersphere/error.hpp"

namespace innersphere {

/// Throws Error device_out_of_memory or device_error with the call, its place and CUDA's reason.
inline void checkCuda(cudaError_t status, const char* call, const char* file, int line) {
  if (status == cudaSuccess) return;
  cudaGetLastError();  // forget it, so that the next call does not report it again
  const char* slash = std::strrchr(file, '/');
  const std::string what = std::string(call) + " at " + (slash ? slash + 1 : file) + ":" +
                           std::to_string(line) + " failed: " + cudaGetErrorString(status);
  throw Error(status == cudaErrorMemoryAllocation ? ErrorCode::device_out_of_memory : ErrorCode::device_error,
              what);
}

#define INNERSPHERE_CUDA(call) ::innersphere::checkCuda((call), #call, __FILE__, __LINE__)

/// Allocates memory of the device.
struct OnDevice {
  static cudaError_t allocate(void** p, std::size_t bytes) { return cudaMalloc(p, bytes); }
  static void release(void* p) { cudaFree(p); }
};

/// Allocates memory of the host that the device copies from and to without a detour.
struct Pinned {
  static cudaError_t allocate(void** p, std::size_t bytes) { return cudaMallocHost(p, bytes); }
  static void release(void* p) { cudaFreeHost(p); }
};

/// This is an array that keeps its memory and only grows. Growing loses the content.
template <typename T, typename Memory>
class CudaArray {
 public:
  CudaArray() = default;
  ~CudaArray() { Memory::release(data_); }
  CudaArray(const CudaArray&) = delete;
  CudaArray& operator=(const CudaArray&) = delete;

  void reserve(std::size_t count) {
    if (count <= capacity_) return;
    Memory::release(data_);
    data_ = nullptr;
    capacity_ = 0;
    INNERSPHERE_CUDA(Memory::allocate(reinterpret_cast<void**>(&data_), count * sizeof(T)));
    capacity_ = count;
  }

  T* data() const { return data_; }
  std::size_t capacity() const { return capacity_; }

 private:
  T* data_ = nullptr;
  std::size_t capacity_ = 0;
};
template <typename T>
using DeviceArray = CudaArray<T, OnDevice>;
template <typename T>
using PinnedArray = CudaArray<T, Pinned>;

/// Calls a function of CUB with memory for its own use.
template <typename F>
void withScratch(DeviceArray<std::byte>& scratch, const F& f) {
  std::size_t size = 0;
  INNERSPHERE_CUDA(f(nullptr, size));
  scratch.reserve(size);
  INNERSPHERE_CUDA(f(scratch.data(), size));
}

/// This is a moment in a stream, made on first use.
class Event {
 public:
  Event() = default;
  ~Event() {
    if (event_) cudaEventDestroy(event_);
  }
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;

  cudaEvent_t get() {
    if (!event_) INNERSPHERE_CUDA(cudaEventCreate(&event_));
    return event_;
  }

 private:
  cudaEvent_t event_ = nullptr;
};

inline double secondsBetween(Event& start, Event& stop) {
  float milliseconds = 0;
  INNERSPHERE_CUDA(cudaEventElapsedTime(&milliseconds, start.get(), stop.get()));
  return 1e-3 * static_cast<double>(milliseconds);
}

template <typename T>
void copyAsync(T* to, const T* from, std::size_t count, cudaStream_t stream) {
  INNERSPHERE_CUDA(cudaMemcpyAsync(to, from, count * sizeof(T), cudaMemcpyDefault, stream));
}

/// Says where memory is.
struct MemoryOf {
  void* on_device = nullptr;  ///< As kernels name it. Null: memory of the host that no device knows.
  int device = -1;            ///< Whose it is; -1: memory of the host that all devices reach.

  bool isReachedFrom(int other) const { return on_device && (device == -1 || device == other); }
};

inline MemoryOf memoryOf(const void* p) {
  cudaPointerAttributes attributes{};
  INNERSPHERE_CUDA(cudaPointerGetAttributes(&attributes, p));
  if (attributes.type == cudaMemoryTypeDevice)  // the attribute's own pointer is null for other devices
    return {const_cast<void*>(p), attributes.device};
  if (attributes.type == cudaMemoryTypeHost || attributes.type == cudaMemoryTypeManaged)
    return {attributes.devicePointer, -1};
  return {};
}

/// Makes a device current and, at the end, the one that was.
class CurrentDevice {
 public:
  explicit CurrentDevice(int device) {
    INNERSPHERE_CUDA(cudaGetDevice(&before_));
    if (before_ != device) INNERSPHERE_CUDA(cudaSetDevice(device));
  }
  ~CurrentDevice() { cudaSetDevice(before_); }
  CurrentDevice(const CurrentDevice&) = delete;
  CurrentDevice& operator=(const CurrentDevice&) = delete;

 private:
  int before_ = 0;
};

}  // namespace innersphere
