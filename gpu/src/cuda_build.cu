// The build of a grid in one launch, whose threads wait for each other between the steps.
#include <cooperative_groups.h>
#include <cub/block/block_reduce.cuh>
#include <cub/block/block_scan.cuh>

#include <algorithm>

#include "cuda_dense.hpp"

namespace innersphere::device {

namespace {

constexpr unsigned kBlocks = 4;  ///< on a multiprocessor, at least
constexpr unsigned kWarps = kListThreads / kWarp;

template <typename T>
using BlockSum = cub::BlockReduce<T, kListThreads>;
template <typename T>
using BlockScan = cub::BlockScan<T, kListThreads>;

union Shared {
  core::HilbertTable table;
  core::CellsNear near[kWarps][kWarp];
  ListInOrder lists[kListThreads / kLanes];
  BlockSum<std::uint64_t>::TempStorage sum;
  BlockScan<std::uint64_t>::TempStorage scan;
};

__constant__ core::HilbertTable hilbert_table = core::kHilbertTable;

/// out[i]: the sum of in(0) to in(i - 1). A block takes a run of them.
template <typename Out, typename In>
__device__ void sumUp(const cooperative_groups::grid_group& all, const In& in, std::uint64_t count, Out* out,
                      std::uint64_t* block_sums, Shared& shared) {
  __shared__ std::uint64_t before_block;
  const std::uint64_t run = (count + gridDim.x - 1) / gridDim.x;
  const std::uint64_t begin = min(count, run * blockIdx.x), end = min(count, begin + run);
  std::uint64_t sum = 0;
  for (std::uint64_t i = begin + threadIdx.x; i < end; i += kListThreads) sum += in(i);
  sum = BlockSum<std::uint64_t>(shared.sum).Sum(sum);
  if (threadIdx.x == 0) block_sums[blockIdx.x] = sum;
  all.sync();
  sum = 0;
  for (unsigned block = threadIdx.x; block < blockIdx.x; block += kListThreads) sum += block_sums[block];
  sum = BlockSum<std::uint64_t>(shared.sum).Sum(sum);
  if (threadIdx.x == 0) before_block = sum;
  __syncthreads();
  std::uint64_t before = before_block;
  for (std::uint64_t first = begin; first < end; first += kListThreads) {
    const std::uint64_t i = first + threadIdx.x;
    std::uint64_t here = i < end ? in(i) : 0, total = 0;
    BlockScan<std::uint64_t>(shared.scan).ExclusiveSum(here, here, total);
    if (i < end) out[i] = static_cast<Out>(before + here);
    before += total;
    __syncthreads();
  }
}

__global__ void __launch_bounds__(kListThreads, kBlocks)
    buildGrid(const __grid_constant__ BuildPlan plan, const __grid_constant__ GridArrays grid,
              const __grid_constant__ BuildArrays arrays, BuildSteps steps) {
  __shared__ Shared shared;
  const cooperative_groups::grid_group all = cooperative_groups::this_grid();
  const Threads threads{std::uint64_t{blockIdx.x} * kListThreads + threadIdx.x,
                        std::uint64_t{gridDim.x} * kListThreads};
  core::CellsNear(&near)[kWarp] = shared.near[threadIdx.x / kWarp];
  const std::uint64_t cell_count = plan.tiers.first[plan.tiers.count];
  if (steps.order) {
    for (unsigned i = threadIdx.x; i < sizeof shared.table / sizeof(unsigned); i += kListThreads)
      reinterpret_cast<unsigned*>(&shared.table)[i] = reinterpret_cast<const unsigned*>(&hilbert_table)[i];
    __syncthreads();
    makeKeys(plan, grid, arrays, shared.table, threads);
    all.sync();
    sumUp(
        all, [&](std::uint64_t i) { return arrays.bucket_counts[i]; }, plan.buckets + 1, arrays.bucket_starts,
        arrays.block_sums, shared);
    all.sync();
    fillBuckets(plan, arrays, threads);
    all.sync();
    orderBuckets(plan, arrays, threads);
    all.sync();
    orderSpheres(plan, grid, arrays, steps.count, near, threads);
    if (!steps.count) return;
    all.sync();
    sumUp(
        all, [&](std::uint64_t i) { return packed(arrays.cell_counts[i]); }, cell_count + 1, arrays.cell_sums,
        arrays.block_sums, shared);
    all.sync();
  }
  const DenseCells cells{{arrays.cell_counts, arrays.cell_sums, cell_count}};
  fillLists(plan, grid, arrays, cells, near, threads);
  all.sync();
  orderLists(plan, grid, arrays, cells, shared.lists[threadIdx.x / kLanes], threads);
}

/// All blocks must run side by side.
unsigned mostBlocks() {
  int device = 0, processors = 0, blocks = 0;
  INNERSPHERE_CUDA(cudaGetDevice(&device));
  INNERSPHERE_CUDA(cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device));
  INNERSPHERE_CUDA(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, buildGrid, kListThreads, 0));
  return static_cast<unsigned>(processors * blocks);
}

}  // namespace

void launchBuild(const BuildPlan& plan, const GridArrays& grid, const Sphere* given, BuildSteps steps,
                 BuildScratch& scratch, cudaStream_t stream) {
  const std::uint32_t spheres = plan.grid.view.count;
  const std::uint64_t cells = steps.count ? plan.tiers.first[plan.tiers.count] + 1 : 0;
  const std::uint64_t buckets = plan.buckets + 1, counters = buckets + cells + 1;
  const unsigned most = mostBlocks();
  for (auto& keys : scratch.keys) keys.reserve(spheres);
  for (auto& numbers : scratch.numbers) numbers.reserve(spheres);
  scratch.sorted.reserve(spheres);
  scratch.counts.reserve(counters);
  scratch.starts.reserve(buckets);
  scratch.sums.reserve(cells);
  scratch.block_sums.reserve(most);
  scratch.status.reserve(1);
  std::uint32_t* const counts = scratch.counts.data();
  if (steps.order) INNERSPHERE_CUDA(cudaMemsetAsync(counts, 0, counters * sizeof(std::uint32_t), stream));
  BuildPlan plan_argument = plan;
  GridArrays grid_argument = grid;
  BuildArrays arrays{given,
                     scratch.keys[0].data(),
                     scratch.numbers[0].data(),
                     scratch.keys[1].data(),
                     scratch.numbers[1].data(),
                     scratch.sorted.data(),
                     counts,
                     scratch.starts.data(),
                     counts + buckets,
                     scratch.sums.data(),
                     scratch.block_sums.data(),
                     counts + buckets + cells,
                     scratch.status.data()};
  void* arguments[] = {&plan_argument, &grid_argument, &arrays, &steps};
  const std::uint64_t busy = std::max({std::uint64_t{spheres}, cells, std::uint64_t{kWarp} * plan.jobs.all});
  const auto blocks =
      static_cast<unsigned>(std::min<std::uint64_t>(most, (busy + kListThreads - 1) / kListThreads));
  INNERSPHERE_CUDA(cudaLaunchCooperativeKernel(buildGrid, blocks, kListThreads, arguments, 0, stream));
}

}  // namespace innersphere::device
