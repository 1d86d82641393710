// What a grid on a device has besides that of the CPU.
#pragma once

#include <cstddef>

#include "cuda_batch.hpp"

namespace innersphere::device {

/// Fills what only kernels read.
void fillGrid(const core::GridView& grid, std::uint32_t* listed, Sphere* entries, Sphere* groups,
              std::uint32_t* places, cudaStream_t stream);

/// Of view.listed and Grid::entries.
inline std::size_t entryCount(const core::GridView& grid) {
  return std::size_t{grid.listed_count} + grid.count + core::kListStep;
}

inline std::size_t groupCount(const core::GridView& grid) {
  return (grid.cluster_count + kGroup - 1) / kGroup;
}

}  // namespace innersphere::device
