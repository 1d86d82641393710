// In place of the CUDA backend where InnerSphere is built without the toolkit.
#include "cuda/cuda_backend.hpp"
#include "innersphere/error.hpp"

namespace innersphere {

bool cudaDeviceAnswers() {
  return false;
}

int cudaDevices() {
  return 0;
}

bool isOnCudaDevice(const void*) {
  return false;
}

std::unique_ptr<QueryBackend> makeCudaBackend(Workers&, const QueryContextOptions&) {
  throw Error(
      ErrorCode::no_device,
      "InnerSphere was built without CUDA; install the toolkit and configure with INNERSPHERE_CUDA=ON");
}

}  // namespace innersphere
