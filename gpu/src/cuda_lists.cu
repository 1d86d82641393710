// The lists of cells that all have a counter: summed up, filled in any order, and then put in order.
#include <thrust/iterator/transform_iterator.h>
#include <cub/device/device_scan.cuh>

#include "cuda_cells.hpp"
#include "cuda_lists.hpp"

namespace innersphere::device {

namespace {

constexpr unsigned kWarps = kListThreads / kWarp;

/// The first blocks put cells into the table, the others spheres into lists, as counted.
__global__ void __launch_bounds__(kListThreads)
    fillLists(const __grid_constant__ BuildPlan plan, const __grid_constant__ GridArrays arrays,
              const DenseCells cells, unsigned inserting_blocks, unsigned* longest) {
  __shared__ core::CellsNear shared[kWarps][kWarp];
  if (blockIdx.x < inserting_blocks)
    return insertCell(plan, arrays, cells, std::uint64_t{blockIdx.x} * kListThreads + threadIdx.x, longest);
  const unsigned lane = threadIdx.x % kWarp, warp = threadIdx.x / kWarp;
  ClusterJob job;
  if (!fits(cells.status(0), arrays) ||
      !clusterJob(plan, (blockIdx.x - inserting_blocks) * kWarps + warp, job))
    return;
  const Sphere s = lane < job.count ? plan.grid.centred(load(arrays.spheres + job.first + lane)) : Sphere{};
  auto* const next = reinterpret_cast<unsigned long long*>(cells.sums) + plan.tiers.first[job.tier];
  forCells<std::uint32_t>(plan.tiers, job, s, lane, shared[warp],
                          [&](const std::uint32_t(&of_tier)[kTogether], unsigned mask, std::uint32_t place) {
                            unsigned long long at[kTogether];
#pragma unroll
                            for (unsigned k = 0; k < kTogether; ++k) {
                              if ((mask >> k & 1) != 0) at[k] = atomicAdd(next + of_tier[k], 1ull);
                            }
#pragma unroll
                            for (unsigned k = 0; k < kTogether; ++k) {
                              if ((mask >> k & 1) != 0) arrays.listed[placesOf(at[k])] = place;
                            }
                          });
}

constexpr unsigned kLanes = 16;  ///< that put a list in order
constexpr unsigned kRows = kListThreads / kLanes;

/// Puts a cell's places in order.
__device__ void orderList(const core::GridPlan& plan, const GridArrays& arrays, std::uint64_t first,
                          std::uint32_t count, unsigned lane, unsigned lanes,
                          std::uint32_t (&shared)[kLongestInOrder]) {
  for (std::uint32_t k = lane; k < count; k += kLanes) shared[k] = arrays.listed[first + k];
  __syncwarp(lanes);
  for (std::uint32_t k = lane; k < core::padded(count); k += kLanes) {
    const std::uint32_t place = k < count ? shared[k] : plan.view.count;
    const Sphere entry = entryOf(plan, arrays, place);  // on its way while the others are counted
    std::uint32_t rank = k < count ? 0 : k;
    for (std::uint32_t other = 0; k < count && other < count; ++other) rank += shared[other] < place ? 1 : 0;
    arrays.listed[first + rank] = place;
    arrays.entries[first + rank] = entry;
  }
  __syncwarp(lanes);
}

/// kLanes take a cell.
__global__ void __launch_bounds__(kListThreads)
    orderLists(const __grid_constant__ BuildPlan plan, const __grid_constant__ GridArrays arrays,
               const DenseCells cells, const unsigned* longest, BuildStatus* to_host) {
  __shared__ std::uint32_t shared[kRows][kLongestInOrder];
  const unsigned lane = threadIdx.x % kLanes, row = threadIdx.x / kLanes;
  const unsigned lanes = ((1u << kLanes) - 1) << (row % (kWarp / kLanes) * kLanes);
  const std::uint64_t thread = std::uint64_t{blockIdx.x} * kListThreads + threadIdx.x;
  const std::uint64_t threads = std::uint64_t{gridDim.x} * kListThreads;
  const BuildStatus status = cells.status(*longest);
  if (thread == 0) *to_host = status;
  if (!fits(status, arrays) || status.longest > kLongestInOrder) return;
  for (std::uint64_t cell = thread / kLanes; cell < cells.cells; cell += threads / kLanes) {
    const std::uint32_t count = cells.counts[cell];
    if (count != 0)
      orderList(plan.grid, arrays, placesOf(cells.sums[cell]) - count, count, lane, lanes, shared[row]);
  }
  finishGrid(plan, arrays, cells, status, thread, threads);
}

}  // namespace

void launchFill(const BuildPlan& plan, const GridArrays& arrays, BuildScratch& scratch, cudaStream_t stream) {
  const std::uint64_t count = plan.tiers.first[plan.tiers.count];
  scratch.sums.reserve(count + 1);
  scratch.status.reserve(1);
  const std::uint32_t* const counts = scratch.counts.data() + plan.buckets + 1;
  unsigned* const longest = scratch.counts.data() + plan.buckets + 1 + count + 1;  // see launchOrder()
  withScratch(scratch.cub, [&](void* p, std::size_t& size) {
    return cub::DeviceScan::ExclusiveSum(p, size, thrust::make_transform_iterator(counts, Packed{}),
                                         scratch.sums.data(), static_cast<int>(count + 1), stream);
  });
  const DenseCells cells{{counts, scratch.sums.data(), count}};
  const auto blocks = [](std::uint64_t threads) {
    return static_cast<unsigned>((threads + kListThreads - 1) / kListThreads);
  };
  const unsigned inserting = blocks(count);
  fillLists<<<inserting + blocks(std::uint64_t{kWarp} * plan.jobs.all), kListThreads, 0, stream>>>(
      plan, arrays, cells, inserting, longest);
  orderLists<<<blocks(kLanes * count), kListThreads, 0, stream>>>(plan, arrays, cells, longest,
                                                                  scratch.status.data());
  INNERSPHERE_CUDA(cudaGetLastError());
}

}  // namespace innersphere::device
