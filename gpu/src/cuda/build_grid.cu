// The build of a grid in one launch, whose threads wait for each other between the steps.
#include <cooperative_groups.h>
#include <cub/block/block_reduce.cuh>
#include <cub/block/block_scan.cuh>

#include <algorithm>

#include "cuda/dense_lists.hpp"

namespace innersphere::device {

namespace {

constexpr unsigned kBlocks = 3;  ///< on a multiprocessor, at least; with more of them registers spill
constexpr unsigned kWarps = kListThreads / kWarp;

template <typename T>
using BlockSum = cub::BlockReduce<T, kListThreads>;
template <typename T>
using BlockScan = cub::BlockScan<T, kListThreads>;

union Shared {
  core::HilbertTable table;
  WarpCells cells[kWarps];
  ListInOrder lists[kListThreads / kLanes];
  BlockSum<std::uint64_t>::TempStorage sum;
  BlockScan<std::uint64_t>::TempStorage scan;
};

__constant__ core::HilbertTable hilbert_table = core::kHilbertTable;

/// Calls out(i, the sum of in(0) to in(i - 1)). A block takes a run of them.
template <typename In, typename Out>
__device__ void sumUp(const cooperative_groups::grid_group& all, const In& in, std::uint64_t count,
                      const Out& out, std::uint64_t* block_sums, Shared& shared) {
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
    if (i < end) out(i, before + here);
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
  WarpCells& of_warp = shared.cells[threadIdx.x / kWarp];
  const std::uint64_t cell_count = steps.count ? plan.grid_levels.first[plan.grid_levels.count] : 0;
  if (steps.order) {
    for (unsigned i = threadIdx.x; i < sizeof shared.table / sizeof(unsigned); i += kListThreads)
      reinterpret_cast<unsigned*>(&shared.table)[i] = reinterpret_cast<const unsigned*>(&hilbert_table)[i];
    __syncthreads();
    makeKeys(plan, arrays, shared.table, threads);
    all.sync();
    sumUp(
        all, [&](std::uint64_t i) { return arrays.in_buckets[i]; }, std::uint64_t{plan.buckets.all} + 1,
        [&](std::uint64_t i, std::uint64_t sum) {
          arrays.bucket_starts[i] = static_cast<std::uint32_t>(sum);
        },
        arrays.block_sums, shared);
    all.sync();
    fillBuckets(plan, grid, arrays, cell_count, threads);
    all.sync();
    orderBuckets(plan, grid, arrays, threads);
    all.sync();
    makeClusters(plan, grid, arrays, steps.count, of_warp, threads);
    if (!steps.count) return;
    all.sync();
    sumUp(
        all, [&](std::uint64_t i) { return packed(arrays.cell_counts[i]); }, cell_count + 1,
        [&](std::uint64_t cell, std::uint64_t sum) {
          arrays.cell_sums[cell] = sum;
          const std::uint32_t count = arrays.cell_counts[cell];
          if (count > 0)
            arrays.used[sum >> kPlaceBits] = {keyOf(plan.grid_levels, cell),
                                              static_cast<std::uint32_t>(placesOf(sum)), count};
        },
        arrays.block_sums, shared);
    all.sync();
  }
  const DenseCells cells{{arrays.cell_counts, arrays.cell_sums, cell_count}, arrays.used};
  fillGrid(plan, grid, arrays, cells, of_warp, threads);
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
  const std::uint64_t cells = steps.count ? plan.grid_levels.first[plan.grid_levels.count] : 0;
  const std::uint64_t buckets = plan.buckets.all + 1;
  if (scratch.most_blocks == 0) scratch.most_blocks = mostBlocks();
  for (auto& keys : scratch.keys) keys.reserve(spheres);
  for (auto& numbers : scratch.numbers) numbers.reserve(spheres);
  if (scratch.in_buckets.capacity() < buckets) {
    scratch.in_buckets.reserve(buckets);
    INNERSPHERE_CUDA(cudaMemsetAsync(scratch.in_buckets.data(), 0, buckets * sizeof(std::uint32_t), stream));
  }
  scratch.counts.reserve(cells + 2);
  scratch.starts.reserve(buckets);
  scratch.sums.reserve(cells + 1);
  scratch.used.reserve(cells);
  scratch.block_sums.reserve(scratch.most_blocks);
  scratch.status.reserve(1);
  BuildPlan plan_argument = plan;
  GridArrays grid_argument = grid;
  BuildArrays arrays{given,
                     scratch.keys[0].data(),
                     scratch.numbers[0].data(),
                     scratch.keys[1].data(),
                     scratch.numbers[1].data(),
                     scratch.in_buckets.data(),
                     scratch.starts.data(),
                     scratch.counts.data(),
                     scratch.sums.data(),
                     scratch.used.data(),
                     scratch.block_sums.data(),
                     scratch.counts.data() + cells + 1,
                     scratch.status.data()};
  void* arguments[] = {&plan_argument, &grid_argument, &arrays, &steps};
  const std::uint64_t busy = std::max(cells, std::uint64_t{kWarp} * plan.list_tasks.all + spheres);
  const auto blocks = static_cast<unsigned>(
      std::min<std::uint64_t>(scratch.most_blocks, (busy + kListThreads - 1) / kListThreads));
  INNERSPHERE_CUDA(cudaLaunchCooperativeKernel(buildGrid, blocks, kListThreads, arguments, 0, stream));
}

}  // namespace innersphere::device
