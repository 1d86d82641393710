// Runs the query on NVIDIA GPUs. Without the CUDA toolkit the same functions say that there is no device.
#pragma once

#include <memory>

#include "batch/backend.hpp"
#include "common/workers.hpp"

namespace innersphere {

/// Returns true if CUDA is compiled in and a device answers. Creates no CUDA context.
bool cudaDeviceAnswers();

/// Returns the number of devices that answer. Creates no CUDA context.
int cudaDevices();

/// Returns true for memory that only a device reaches.
bool isOnCudaDevice(const void* p);

/// Returns a backend that uses the device of the options; kCurrentDevice: the one that is current in the
/// calling thread when it first runs; kAllDevices: all. Throws Error no_device if there is none of that
/// number.
std::unique_ptr<QueryBackend> makeCudaBackend(Workers& workers, const QueryContextOptions& options);

}  // namespace innersphere
