// Keeps grids in the memory of a device.
#pragma once

#include "cuda/build_grid.hpp"
#include "grid/model_grid.hpp"

namespace innersphere::device {

/// This is a grid that the device builds, the same as that of the CPU. It has what the kernels of a query
/// read: no tree of clusters and no occupancy.
class CudaGrid : public DeviceGrid {
 public:
  explicit CudaGrid(int device) : device_(device) {}

  /// Makes it the grid of these spheres, which are in the memory of the host or of the device, which must be
  /// current; it is done when this returns. Building once more allocates only where more memory is needed
  /// than ever.
  void build(const Sphere* spheres, const core::GridPlan& plan, cudaStream_t stream);

  int device() const override { return device_; }
  const Grid* onDevice() const { return header_.data(); }

  std::uint64_t version = 0;  ///< of the model's spheres; 0: not built

 private:
  GridArrays arrays() const;
  const Sphere* onDevice(const Sphere* spheres, std::size_t count, cudaStream_t stream);
  bool finish(const BuildPlan& plan, cudaStream_t stream);
  void makeRoom(const BuildStatus& status, std::uint32_t spheres, cudaStream_t stream);

  int device_;
  DeviceArray<Grid> header_;
  DeviceArray<Sphere> spheres_, groups_;
  DeviceArray<EntryPair> entries_;
  DeviceArray<std::uint32_t> ids_, places_, listed_;
  DeviceArray<core::Cluster> clusters_;
  DeviceArray<core::Cell> cells_;
  std::unique_ptr<BuildScratch> scratch_;  ///< kept where it is built more than once
};

/// Returns the grid on a device, which must be current; it is built there on first use and when the spheres
/// have changed. Safe to call from several threads.
const CudaGrid& gridOnDevice(const ModelGrid& grid, int device, cudaStream_t stream);

}  // namespace innersphere::device
