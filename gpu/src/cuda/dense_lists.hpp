// Does the last steps of a build where all cells have a counter: lists are filled in any order, as counted,
// and then put in order.
#pragma once

#include "cuda/cell_lists.hpp"
#include "cuda/order_spheres.hpp"

namespace innersphere::device {

/// Lists a sphere in these cells. As countCells(), a warp takes its places in a list at once.
inline __device__ void listIn(const SomeCells<std::uint32_t>& some, bool together, unsigned long long* next,
                              std::uint32_t* listed, WarpCells& shared) {
  std::uint32_t at[kTogether];  // they are not more than 2^32
  if (!together) {
    forSome(some,
            [&](unsigned k) { at[k] = static_cast<std::uint32_t>(atomicAdd(next + some.cells[k], 1ull)); });
    forSome(some, [&](unsigned k) { listed[at[k]] = some.place; });
    return;
  }
  std::uint32_t before[kTogether];
  forSome(some, [&](unsigned k) { before[k] = atomicAdd(shared.counts + some.in_box[k], 1u); });
  __syncwarp();
  forSome(some, [&](unsigned k) {
    if (before[k] == 0)
      at[k] = static_cast<std::uint32_t>(
          atomicAdd(next + some.cells[k], std::uint64_t{shared.counts[some.in_box[k]]}));
  });
  forSome(some, [&](unsigned k) {
    if (before[k] == 0) shared.counts[some.in_box[k]] = at[k];
  });
  __syncwarp();
  forSome(some, [&](unsigned k) { listed[shared.counts[some.in_box[k]] + before[k]] = some.place; });
  __syncwarp();
  forSome(some, [&](unsigned k) {
    if (before[k] == 0) shared.counts[some.in_box[k]] = 0;
  });
  __syncwarp();
}

/// Puts a cluster's spheres into lists.
inline __device__ void fillLists(const BuildPlan& plan, const GridArrays& grid, std::uint64_t* sums,
                                 unsigned number, unsigned lane, WarpCells& shared) {
  const ListTask task = listTask(plan, number);
  const Sphere s =
      lane < task.count ? plan.grid.centred(loadNew(grid.spheres + task.first + lane)) : Sphere{};
  auto* const next = reinterpret_cast<unsigned long long*>(sums) + plan.grid_levels.first[task.grid_level];
  forCells<std::uint32_t>(plan.grid_levels, task, s, lane, shared.near,
                          [&](const SomeCells<std::uint32_t>& some, bool together) {
                            listIn(some, together, next, grid.listed, shared);
                          });
}

/// Puts cells into the table and spheres into lists, and does what else can be done by now. The last warps
/// have the shortest lists, or none.
inline __device__ void fillGrid(const BuildPlan& plan, const GridArrays& grid, const BuildArrays& arrays,
                                const DenseCells& cells, WarpCells& shared, const Threads& threads) {
  const BuildStatus status = cells.status(0);
  const bool room = fits(status, grid);
  const Threads last_first = threads.reversed();
  last_first.eachWarp((status.cells + kWarp - 1) / kWarp, [&](std::uint64_t run, unsigned lane) {
    const std::uint64_t i = run * kWarp + lane;
    const core::Cell cell = i < status.cells ? cells.used[i] : core::Cell{};
    const std::uint32_t most = maximum(cell.count);
    if (lane == 0 && most > kLongestInOrder) atomicMax(arrays.longest, most);
    if (room && cell.count != 0) insertCell(grid, status.cells, cell.key);
  });
  if (!room) return;
  shared.clear(threads.lane());
  threads.eachWarp(plan.list_tasks.all, [&](std::uint64_t number, unsigned lane) {
    fillLists(plan, grid, cells.sums, static_cast<unsigned>(number), lane, shared);
  });
  last_first.each(entriesOfAll(plan.grid.view.count),
                  [&](std::uint64_t i) { fillEntryOfAll(plan.grid, grid, status.listed, i); });
  const std::uint32_t clusters = plan.grid.view.cluster_count;
  last_first.eachWarp(groupCount(clusters),
                      [&](std::uint64_t group, unsigned lane) { fillGroup(grid, clusters, group, lane); });
}

constexpr unsigned kLanes = 16;  ///< that put a list in order

/// Holds the memory of a list while it is put in order.
struct alignas(16) ListInOrder {
  std::uint32_t filled[kLongestInOrder];
  std::uint32_t sorted[kLongestInOrder];
};
static_assert(core::kListStep == 4 && kLongestInOrder % core::kListStep == 0, "lists are filled up");

/// Puts a cell's places in order: each goes behind those that are smaller.
inline __device__ void orderList(const core::GridPlan& plan, const GridArrays& arrays, const core::Cell& cell,
                                 unsigned lane, unsigned lanes, ListInOrder& shared) {
  const std::uint32_t room = core::padded(cell.count);
  for (std::uint32_t k = lane; k < room; k += kLanes)
    shared.filled[k] = k < cell.count ? arrays.listed[cell.first + k] : plan.view.count;
  __syncwarp(lanes);
  for (std::uint32_t k = lane; k < room; k += 2 * kLanes) {
    const std::uint32_t l = k + kLanes, place = shared.filled[k], place_l = shared.filled[min(l, room - 1)];
    std::uint32_t rank = k < cell.count ? 0 : k - cell.count;  // of those that fill up none is smaller
    std::uint32_t rank_l = l < cell.count ? 0 : l - cell.count;
    for (std::uint32_t other = 0; other < room; other += core::kListStep) {
      const uint4 others = *reinterpret_cast<const uint4*>(shared.filled + other);
      rank += (others.x < place) + (others.y < place) + (others.z < place) + (others.w < place);
      rank_l += (others.x < place_l) + (others.y < place_l) + (others.z < place_l) + (others.w < place_l);
    }
    shared.sorted[rank] = place;
    if (l < room) shared.sorted[rank_l] = place_l;
  }
  __syncwarp(lanes);
  const CellFrame frame = frameOf(plan.view, cell.key);
  for (std::uint32_t k = lane; k < room / 2; k += kLanes) {
    const uint2 places{shared.sorted[2 * k], shared.sorted[2 * k + 1]};
    reinterpret_cast<uint2*>(arrays.listed + cell.first)[k] = places;
    arrays.entries[cell.first / 2 + k] = entriesOf(plan, arrays, frame, places);
  }
  __syncwarp(lanes);
}

/// Puts all lists in order; kLanes take a cell.
inline __device__ void orderLists(const BuildPlan& plan, const GridArrays& grid, const BuildArrays& arrays,
                                  const DenseCells& cells, ListInOrder& shared, const Threads& threads) {
  const unsigned lane = threadIdx.x % kLanes;
  const unsigned lanes = ((1u << kLanes) - 1) << (threadIdx.x % kWarp / kLanes * kLanes);
  const BuildStatus status = cells.status(*arrays.longest);
  if (threads.first == 0) *arrays.to_host = status;
  if (!fits(status, grid) || status.longest > kLongestInOrder) return;
  std::uint64_t i = threads.first / kLanes;
  core::Cell next = i < status.cells ? cells.used[i] : core::Cell{};
  while (i < status.cells) {
    const core::Cell cell = next;
    i += threads.count / kLanes;
    if (i < status.cells) next = cells.used[i];  // on its way meanwhile
    orderList(plan.grid, grid, cell, lane, lanes, shared);
  }
  finishGrid(plan, grid, cells, status, threads.first, threads.count);
}

}  // namespace innersphere::device
