// Grids in the memory of a device.
#pragma once

#include "cuda_fill.hpp"
#include "cuda_memory.hpp"
#include "hash_grid.hpp"

namespace innersphere::device {

/// The grid that the CPU built, copied.
class CudaGrid : public DeviceGrid {
 public:
  CudaGrid(const HashGrid& grid, int device, cudaStream_t stream);

  int device() const override { return device_; }
  const Grid& grid() const { return grid_; }
  const Grid* onDevice() const { return header_.data(); }

 private:
  int device_;
  Grid grid_{};
  DeviceArray<Grid> header_;
  DeviceArray<Sphere> spheres_, centred_, entries_, groups_;
  DeviceArray<std::uint32_t> ids_, places_, listed_;
  DeviceArray<core::Cluster> clusters_;
  DeviceArray<core::Cell> cells_;
};

/// The grid on a device, which must be current; copied there on first use. Safe to call from several threads.
const CudaGrid& gridOnDevice(const HashGrid& grid, int device, cudaStream_t stream);

}  // namespace innersphere::device
