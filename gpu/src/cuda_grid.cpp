#include "cuda_grid.hpp"

#include <memory>

namespace innersphere::device {

namespace {

template <typename T>
void upload(DeviceArray<T>& array, const T*& pointer, std::size_t count, cudaStream_t stream) {
  array.reserve(count);
  copyAsync(array.data(), pointer, count, stream);
  pointer = array.data();
}

}  // namespace

CudaGrid::CudaGrid(const HashGrid& grid, int device, cudaStream_t stream) : device_(device) {
  core::GridView& view = grid_.view;
  view = grid.view();
  upload(spheres_, view.spheres, view.count, stream);
  upload(centred_, view.centred, std::size_t{view.count} + 1, stream);
  upload(ids_, view.ids, view.count, stream);
  upload(clusters_, view.clusters, view.cluster_count, stream);
  upload(cells_, view.cells, grid.tableSize(), stream);
  listed_.reserve(entryCount(view));
  upload(listed_, view.listed, view.listed_count, stream);
  entries_.reserve(entryCount(view));
  groups_.reserve(groupCount(view));
  places_.reserve(view.count);
  fillGrid(view, listed_.data(), entries_.data(), groups_.data(), places_.data(), stream);
  grid_.entries = entries_.data();
  grid_.groups = groups_.data();
  grid_.places = places_.data();
  header_.reserve(1);
  copyAsync(header_.data(), &grid_, 1, stream);
  INNERSPHERE_CUDA(cudaStreamSynchronize(stream));  // other streams may read it from now on
}

const CudaGrid& gridOnDevice(const HashGrid& grid, int device, cudaStream_t stream) {
  HashGrid::DeviceCopies& copies = grid.deviceCopies();
  const std::lock_guard<std::mutex> lock(copies.mutex);
  for (const auto& copy : copies.copies) {
    if (copy->device() == device) return static_cast<const CudaGrid&>(*copy);
  }
  copies.copies.push_back(std::make_unique<CudaGrid>(grid, device, stream));
  return static_cast<const CudaGrid&>(*copies.copies.back());
}

}  // namespace innersphere::device
