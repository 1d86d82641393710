#include "cuda_fill.hpp"

#include "cuda_device.hpp"
#include "cuda_memory.hpp"

namespace innersphere::device {

namespace {

constexpr unsigned kThreads = 256;

__global__ void fillEntries(const core::GridView grid, std::uint32_t* listed, Sphere* entries,
                            std::uint32_t count) {
  const std::uint32_t at = blockIdx.x * blockDim.x + threadIdx.x;
  if (at >= count) return;
  if (at >= grid.listed_count) listed[at] = min(at - grid.listed_count, grid.count);
  entries[at] = load(grid.centred + listed[at]);
}

__global__ void fillPlaces(const core::GridView grid, std::uint32_t* places) {
  const std::uint32_t place = blockIdx.x * blockDim.x + threadIdx.x;
  if (place < grid.count) places[grid.ids[place]] = place;
}

/// A thread takes a group: a ball about the middle of its clusters' balls.
__global__ void fillGroups(const core::GridView grid, Sphere* groups) {
  const std::uint32_t group = blockIdx.x * blockDim.x + threadIdx.x;
  const std::uint32_t begin = group * kGroup, end = min(begin + kGroup, grid.cluster_count);
  if (begin >= end) return;
  const Sphere start = grid.clusters[begin].ball;
  float lo[3] = {start.x, start.y, start.z}, hi[3] = {start.x, start.y, start.z};
  for (std::uint32_t c = begin; c < end; ++c) {
    const Sphere& ball = grid.clusters[c].ball;
    const float p[3] = {ball.x, ball.y, ball.z};
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis] = fminf(lo[axis], p[axis] - ball.radius);
      hi[axis] = fmaxf(hi[axis], p[axis] + ball.radius);
    }
  }
  const core::Vec3f middle{0.5f * (lo[0] + hi[0]), 0.5f * (lo[1] + hi[1]), 0.5f * (lo[2] + hi[2])};
  double radius = 0;
  for (std::uint32_t c = begin; c < end; ++c) {
    const Sphere& ball = grid.clusters[c].ball;
    const core::Vec3r d{double(ball.x) - middle.x, double(ball.y) - middle.y, double(ball.z) - middle.z};
    radius = fmax(radius, sqrt(dot(d, d)) + ball.radius);
  }
  groups[group] = {middle.x, middle.y, middle.z, __double2float_ru(radius)};
}

}  // namespace

void fillGrid(const core::GridView& grid, std::uint32_t* listed, Sphere* entries, Sphere* groups,
              std::uint32_t* places, cudaStream_t stream) {
  const auto blocks = [](std::size_t n) { return static_cast<unsigned>((n + kThreads - 1) / kThreads); };
  const std::size_t entry_count = entryCount(grid);
  fillEntries<<<blocks(entry_count), kThreads, 0, stream>>>(grid, listed, entries,
                                                            static_cast<std::uint32_t>(entry_count));
  fillGroups<<<blocks(groupCount(grid)), kThreads, 0, stream>>>(grid, groups);
  fillPlaces<<<blocks(grid.count), kThreads, 0, stream>>>(grid, places);
  INNERSPHERE_CUDA(cudaGetLastError());
}

}  // namespace innersphere::device
