// Grids in the memory of a device.
#pragma once

#include <mutex>

#include "cuda_memory.hpp"
#include "hash_grid.hpp"

namespace innersphere {

/// The grid that the CPU built, copied. Both backends therefore walk the same cells in the same order.
class CudaGrid : public DeviceGrid {
 public:
  CudaGrid(const HashGrid& grid, int device, cudaStream_t stream) : device_(device), view_(grid.view()) {
    upload(spheres_, view_.spheres, view_.count, stream);
    upload(centred_, view_.centred, std::size_t{view_.count} + 1, stream);
    upload(ids_, view_.ids, view_.count, stream);
    upload(clusters_, view_.clusters, view_.cluster_count, stream);
    upload(cells_, view_.cells, grid.tableSize(), stream);
    upload(listed_, view_.listed, view_.listed_count, stream);
    INNERSPHERE_CUDA(cudaStreamSynchronize(stream));  // other streams may read it from now on
  }

  int device() const override { return device_; }
  const core::GridView& view() const { return view_; }

 private:
  template <typename T>
  static void upload(DeviceArray<T>& array, const T*& pointer, std::size_t count, cudaStream_t stream) {
    array.reserve(count);
    copyAsync(array.data(), pointer, count, stream);
    pointer = array.data();
  }

  int device_;
  core::GridView view_;
  DeviceArray<Sphere> spheres_;
  DeviceArray<Sphere> centred_;
  DeviceArray<std::uint32_t> ids_;
  DeviceArray<core::Cluster> clusters_;
  DeviceArray<core::Cell> cells_;
  DeviceArray<std::uint32_t> listed_;
};

/// The grid on a device, which must be current; copied there on first use. Safe to call from several threads.
inline const core::GridView& viewOnDevice(const HashGrid& grid, int device, cudaStream_t stream) {
  HashGrid::DeviceCopies& copies = grid.deviceCopies();
  const std::lock_guard<std::mutex> lock(copies.mutex);
  for (const auto& copy : copies.copies) {
    if (copy->device() == device) return static_cast<const CudaGrid&>(*copy).view();
  }
  auto copy = std::make_unique<CudaGrid>(grid, device, stream);
  const core::GridView& view = copy->view();
  copies.copies.push_back(std::move(copy));
  return view;
}

}  // namespace innersphere
