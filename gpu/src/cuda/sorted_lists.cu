// The lists of cells that are too many for a counter each, or have very long lists: all pairs of a cell and
// a sphere that it lists, sorted.
#include <thrust/iterator/transform_iterator.h>
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_run_length_encode.cuh>
#include <cub/device/device_scan.cuh>

#include "cuda/cell_lists.hpp"
#include "cuda/cells.hpp"

namespace innersphere::device {

namespace {

constexpr unsigned kWarps = kListThreads / kWarp;

unsigned blocksFor(std::uint64_t threads) {
  return static_cast<unsigned>((threads + kListThreads - 1) / kListThreads);
}

/// Counts the pairs and, with `keys`, writes them.
__global__ void findPairs(const __grid_constant__ BuildPlan plan, const Sphere* spheres,
                          unsigned long long* found, std::uint64_t* keys, std::uint32_t* numbers) {
  __shared__ core::CellsNear shared[kWarps][kWarp];
  const unsigned lane = threadIdx.x % kWarp, warp = threadIdx.x / kWarp;
  const unsigned number = blockIdx.x * kWarps + warp;
  if (number >= plan.list_tasks.all) return;
  const ListTask task = listTask(plan, number);
  const Sphere s = lane < task.count ? plan.grid.centred(load(spheres + task.first + lane)) : Sphere{};
  forCells<std::uint64_t>(
      plan.grid_levels, task, s, lane, shared[warp], [&](const SomeCells<std::uint64_t>& some, bool) {
        unsigned long long at = atomicAdd(found, static_cast<unsigned long long>(__popc(some.mask)));
        if (!keys) return;
        forSome(some, [&](unsigned k) {
          keys[at] = plan.grid_levels.of[task.grid_level].keyOf(some.cells[k]);
          numbers[at++] = some.place;
        });
      });
}

/// A thread takes a cell.
__global__ void insertCells(const __grid_constant__ GridArrays arrays, const SortedCells cells) {
  const std::uint64_t cell = std::uint64_t{blockIdx.x} * kListThreads + threadIdx.x;
  if (cell < cells.cells) insertCell(arrays, cells.cells, cells.keys[cell]);
}

/// A warp takes a cell.
__global__ void writeLists(const __grid_constant__ BuildPlan plan, const __grid_constant__ GridArrays arrays,
                           const SortedCells cells, const std::uint32_t* starts,
                           const std::uint32_t* numbers) {
  const unsigned lane = threadIdx.x % kWarp;
  const std::uint64_t thread = std::uint64_t{blockIdx.x} * kListThreads + threadIdx.x;
  const std::uint64_t threads = std::uint64_t{gridDim.x} * kListThreads;
  for (std::uint64_t cell = thread / kWarp; cell < cells.cells; cell += threads / kWarp) {
    const std::uint32_t count = cells.counts[cell];
    const std::uint64_t first = placesOf(cells.sums[cell]);
    const CellFrame frame = frameOf(plan.grid.view, cells.keys[cell]);
    const auto placeAt = [&](std::uint32_t k) {
      return k < count ? numbers[starts[cell] + k] : plan.grid.view.count;
    };
    for (std::uint32_t k = lane; k < core::padded(count) / 2; k += kWarp) {
      const uint2 places{placeAt(2 * k), placeAt(2 * k + 1)};
      reinterpret_cast<uint2*>(arrays.listed + first)[k] = places;
      arrays.entries[first / 2 + k] = entriesOf(plan.grid, arrays, frame, places);
    }
  }
  const BuildStatus status = cells.status(0);
  for (std::uint64_t i = thread; i < entriesOfAll(plan.grid.view.count); i += threads)
    fillEntryOfAll(plan.grid, arrays, status.listed, i);
  const std::uint32_t clusters = plan.grid.view.cluster_count;
  for (std::uint64_t group = thread / kWarp; group < groupCount(clusters); group += threads / kWarp)
    fillGroup(arrays, clusters, group, lane);
  finishGrid(plan, arrays, cells, status, thread, threads);
}

template <typename T>
T fetch(const T* from, cudaStream_t stream) {
  T value{};
  copyAsync(&value, from, 1, stream);
  INNERSPHERE_CUDA(cudaStreamSynchronize(stream));
  return value;
}

int bitsOf(std::uint32_t number) {
  int bits = 1;
  while (number >> bits != 0) ++bits;
  return bits;
}

}  // namespace

BuildStatus sortLists(const BuildPlan& plan, const GridArrays& arrays, BuildScratch& scratch,
                      cudaStream_t stream) {
  scratch.found.reserve(1);
  std::uint64_t pairs = 0;
  const auto find = [&](std::uint64_t* keys, std::uint32_t* numbers) {
    INNERSPHERE_CUDA(cudaMemsetAsync(scratch.found.data(), 0, sizeof(unsigned long long), stream));
    findPairs<<<blocksFor(std::uint64_t{kWarp} * plan.list_tasks.all), kListThreads, 0, stream>>>(
        plan, arrays.spheres, scratch.found.data(), keys, numbers);
    INNERSPHERE_CUDA(cudaGetLastError());
  };
  find(nullptr, nullptr);
  pairs = fetch(scratch.found.data(), stream);
  if (pairs >> 32 != 0)
    throw Error(ErrorCode::bad_argument, "the spheres fill more than 2^32 places in the grid; use fewer");
  for (auto& keys : scratch.keys) keys.reserve(pairs);
  for (auto& numbers : scratch.numbers) numbers.reserve(pairs);
  std::uint64_t *keys = scratch.keys[0].data(), *other_keys = scratch.keys[1].data();
  std::uint32_t *numbers = scratch.numbers[0].data(), *other_numbers = scratch.numbers[1].data();
  find(keys, numbers);
  const auto count = static_cast<std::int64_t>(pairs);
  withScratch(scratch.cub, [&](void* p, std::size_t& size) {  // both sorts are stable
    return cub::DeviceRadixSort::SortPairs(p, size, numbers, other_numbers, keys, other_keys, count, 0,
                                           bitsOf(plan.grid.view.count), stream);
  });
  withScratch(scratch.cub, [&](void* p, std::size_t& size) {
    return cub::DeviceRadixSort::SortPairs(p, size, other_keys, keys, other_numbers, numbers, count, 0,
                                           3 * core::kAxisBits + bitsOf(plan.grid.view.grid_levels), stream);
  });
  scratch.counts.reserve(pairs + 1);
  withScratch(scratch.cub, [&](void* p, std::size_t& size) {
    return cub::DeviceRunLengthEncode::Encode(p, size, keys, other_keys, scratch.counts.data(),
                                              scratch.found.data(), count, stream);
  });
  const std::uint64_t cells = fetch(scratch.found.data(), stream);
  INNERSPHERE_CUDA(cudaMemsetAsync(scratch.counts.data() + cells, 0, sizeof(std::uint32_t), stream));
  scratch.sums.reserve(cells + 1);
  scratch.starts.reserve(cells + 1);
  withScratch(scratch.cub, [&](void* p, std::size_t& size) {
    return cub::DeviceScan::ExclusiveSum(p, size,
                                         thrust::make_transform_iterator(scratch.counts.data(), Packed{}),
                                         scratch.sums.data(), static_cast<std::int64_t>(cells + 1), stream);
  });
  withScratch(scratch.cub, [&](void* p, std::size_t& size) {
    return cub::DeviceScan::ExclusiveSum(p, size, scratch.counts.data(), scratch.starts.data(),
                                         static_cast<std::int64_t>(cells + 1), stream);
  });
  return {cells, placesOf(fetch(scratch.sums.data() + cells, stream)), 0};
}

void launchSorted(const BuildPlan& plan, const GridArrays& arrays, const BuildStatus& status,
                  BuildScratch& scratch, cudaStream_t stream) {
  SortedCells cells;
  cells.counts = scratch.counts.data();
  cells.sums = scratch.sums.data();
  cells.cells = status.cells;
  cells.keys = scratch.keys[1].data();
  insertCells<<<blocksFor(status.cells), kListThreads, 0, stream>>>(arrays, cells);
  writeLists<<<blocksFor(kWarp * status.cells), kListThreads, 0, stream>>>(
      plan, arrays, cells, scratch.starts.data(), scratch.numbers[0].data());
  INNERSPHERE_CUDA(cudaGetLastError());
}

}  // namespace innersphere::device
