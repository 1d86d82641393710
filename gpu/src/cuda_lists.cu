// The lists of cells that all have a counter: summed up, filled in any order, and then put in order.
#include <thrust/iterator/transform_iterator.h>
#include <cub/device/device_scan.cuh>

#include "cuda_cells.hpp"
#include "cuda_lists.hpp"

namespace innersphere::device {

namespace {

constexpr unsigned kWarps = kListThreads / kWarp;

__global__ void fillLists(const __grid_constant__ BuildPlan plan, const __grid_constant__ GridArrays arrays,
                          const DenseCells cells) {
  __shared__ core::CellsNear shared[kWarps][kWarp];
  const unsigned lane = threadIdx.x % kWarp, warp = threadIdx.x / kWarp;
  ClusterJob job;
  if (!fits(cells.status(0), arrays) || !clusterJob(plan, blockIdx.x * kWarps + warp, job)) return;
  const Sphere s = lane < job.count ? plan.grid.centred(load(arrays.spheres + job.first + lane)) : Sphere{};
  forCells(plan.tiers, job, s, lane, shared[warp],
           [&](const core::TierCells& tier, std::uint64_t first, std::uint32_t x, std::uint32_t y,
               std::uint32_t z, std::uint32_t place) {
             auto* sums = reinterpret_cast<unsigned long long*>(cells.sums);
             arrays.listed[placesOf(atomicAdd(sums + first + tier.cellAt(x, y, z), 1ull))] = place;
           });
}

/// Puts a cell's places in order; a warp calls it.
__device__ void orderList(const core::GridPlan& plan, const GridArrays& arrays, std::uint64_t first,
                          std::uint32_t count, unsigned lane, std::uint32_t (&shared)[kLongestInOrder]) {
  for (std::uint32_t k = lane; k < count; k += kWarp) shared[k] = arrays.listed[first + k];
  __syncwarp();
  for (std::uint32_t k = lane; k < core::padded(count); k += kWarp) {
    const std::uint32_t place = k < count ? shared[k] : plan.view.count;
    std::uint32_t rank = 0;
    if (k < count) {
      for (std::uint32_t other = 0; other < count; ++other) rank += shared[other] < place ? 1 : 0;
    } else {
      rank = k;
    }
    writePlace(plan, arrays, first + rank, place);
  }
  __syncwarp();
}

/// A warp takes a cell.
__global__ void __launch_bounds__(kListThreads)
    orderLists(const __grid_constant__ BuildPlan plan, const __grid_constant__ GridArrays arrays,
               const DenseCells cells, const unsigned* longest, BuildStatus* to_host) {
  __shared__ std::uint32_t shared[kWarps][kLongestInOrder];
  const unsigned lane = threadIdx.x % kWarp, warp = threadIdx.x / kWarp;
  const std::uint64_t thread = std::uint64_t{blockIdx.x} * kListThreads + threadIdx.x;
  const std::uint64_t threads = std::uint64_t{gridDim.x} * kListThreads;
  const BuildStatus status = cells.status(*longest);
  if (thread == 0) *to_host = status;
  if (!fits(status, arrays) || status.longest > kLongestInOrder) return;
  for (std::uint64_t cell = thread / kWarp; cell < cells.cells; cell += threads / kWarp) {
    const std::uint32_t count = cells.counts[cell];
    if (count != 0)
      orderList(plan.grid, arrays, placesOf(cells.sums[cell]) - count, count, lane, shared[warp]);
  }
  finishGrid(plan, arrays, cells, status, thread, threads);
}

}  // namespace

void launchFill(const BuildPlan& plan, const GridArrays& arrays, BuildScratch& scratch, cudaStream_t stream) {
  const std::uint64_t count = plan.tiers.first[plan.tiers.count];
  scratch.sums.reserve(count + 1);
  scratch.longest.reserve(1);
  scratch.status.reserve(1);
  INNERSPHERE_CUDA(cudaMemsetAsync(scratch.longest.data(), 0, sizeof(unsigned), stream));
  if (arrays.table_room > 0)
    INNERSPHERE_CUDA(cudaMemsetAsync(arrays.cells, 0xff, arrays.table_room * sizeof(core::Cell), stream));
  withScratch(scratch.cub, [&](void* p, std::size_t& size) {
    return cub::DeviceScan::ExclusiveSum(p, size,
                                         thrust::make_transform_iterator(scratch.counts.data(), Packed{}),
                                         scratch.sums.data(), static_cast<int>(count + 1), stream);
  });
  const DenseCells cells{{scratch.counts.data(), scratch.sums.data(), count}};
  const auto blocks = [](std::uint64_t threads) {
    return static_cast<unsigned>((threads + kListThreads - 1) / kListThreads);
  };
  insertCells<<<blocks(count), kListThreads, 0, stream>>>(plan, arrays, cells, scratch.longest.data());
  fillLists<<<blocks(std::uint64_t{kWarp} * plan.jobs.first[plan.grid.levels]), kListThreads, 0, stream>>>(
      plan, arrays, cells);
  orderLists<<<blocks(kWarp * count), kListThreads, 0, stream>>>(plan, arrays, cells, scratch.longest.data(),
                                                                 scratch.status.data());
  INNERSPHERE_CUDA(cudaGetLastError());
}

}  // namespace innersphere::device
