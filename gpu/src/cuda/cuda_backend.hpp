// Runs the query on an NVIDIA GPU. Without the CUDA toolkit the same functions say that there is no device.
#pragma once

#include <memory>

#include "batch/backend.hpp"
#include "common/workers.hpp"

namespace innersphere {

/// Returns true if CUDA is compiled in and a device answers. Creates no CUDA context.
bool cudaDeviceAnswers();

/// Returns a backend that uses the device that is current in the calling thread when it first runs. Throws
/// Error no_device if there is none.
std::unique_ptr<QueryBackend> makeCudaBackend(Workers& workers, bool time_kernels);

}  // namespace innersphere
