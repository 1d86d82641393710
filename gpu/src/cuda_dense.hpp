// The last steps of a build where all cells have a counter: lists are filled in any order, as counted, and
// then put in order.
#pragma once

#include "cuda_lists.hpp"
#include "cuda_order.hpp"

namespace innersphere::device {

/// Puts cells into the table and spheres into lists.
inline __device__ void fillLists(const BuildPlan& plan, const GridArrays& grid, const BuildArrays& arrays,
                                 const DenseCells& cells, core::CellsNear (&shared)[kWarp],
                                 const Threads& threads) {
  const bool room = fits(cells.status(0), grid);
  threads.eachWarp((cells.cells + kWarp - 1) / kWarp, [&](std::uint64_t run, unsigned lane) {
    insertCell(plan, grid, cells, run * kWarp + lane, arrays.longest);
  });
  if (!room) return;
  threads.eachWarp(plan.jobs.all, [&](std::uint64_t number, unsigned lane) {
    const ClusterJob job = clusterJob(plan, static_cast<unsigned>(number));
    const Sphere s = lane < job.count ? plan.grid.centred(grid.spheres[job.first + lane]) : Sphere{};
    auto* const next = reinterpret_cast<unsigned long long*>(cells.sums) + plan.tiers.first[job.tier];
    forCells<std::uint32_t>(
        plan.tiers, job, s, lane, shared,
        [&](const std::uint32_t(&of_tier)[kTogether], unsigned mask, std::uint32_t place) {
          unsigned long long at[kTogether];
#pragma unroll
          for (unsigned k = 0; k < kTogether; ++k) {
            if ((mask >> k & 1) != 0) at[k] = atomicAdd(next + of_tier[k], 1ull);
          }
#pragma unroll
          for (unsigned k = 0; k < kTogether; ++k) {
            if ((mask >> k & 1) != 0) grid.listed[placesOf(at[k])] = place;
          }
        });
  });
}

constexpr unsigned kLanes = 16;  ///< that put a list in order

/// Of a list, while it is put in order.
struct ListInOrder {
  std::uint32_t filled[kLongestInOrder];
  std::uint32_t sorted[kLongestInOrder];
};
static_assert(kLongestInOrder % core::kListStep == 0, "lists are filled up");

/// Puts a cell's places in order.
inline __device__ void orderList(const core::GridPlan& plan, const GridArrays& arrays, const CellFrame& frame,
                                 std::uint64_t first, std::uint32_t count, unsigned lane, unsigned lanes,
                                 ListInOrder& shared) {
  for (std::uint32_t k = lane; k < count; k += kLanes) shared.filled[k] = arrays.listed[first + k];
  __syncwarp(lanes);
  for (std::uint32_t k = lane; k < core::padded(count); k += kLanes) {
    const std::uint32_t place = k < count ? shared.filled[k] : plan.view.count;
    std::uint32_t rank = k < count ? 0 : k;
    for (std::uint32_t other = 0; k < count && other < count; ++other)
      rank += shared.filled[other] < place ? 1 : 0;
    shared.sorted[rank] = place;
  }
  __syncwarp(lanes);
  for (std::uint32_t k = lane; k < core::padded(count) / 2; k += kLanes) {
    const uint2 places{shared.sorted[2 * k], shared.sorted[2 * k + 1]};
    reinterpret_cast<uint2*>(arrays.listed + first)[k] = places;
    arrays.entries[first / 2 + k] = entriesOf(plan, arrays, frame, places);
  }
  __syncwarp(lanes);
}

/// kLanes take a cell.
inline __device__ void orderLists(const BuildPlan& plan, const GridArrays& grid, const BuildArrays& arrays,
                                  const DenseCells& cells, ListInOrder& shared, const Threads& threads) {
  const unsigned lane = threadIdx.x % kLanes;
  const unsigned lanes = ((1u << kLanes) - 1) << (threadIdx.x % kWarp / kLanes * kLanes);
  const BuildStatus status = cells.status(*arrays.longest);
  if (threads.first == 0) *arrays.to_host = status;
  if (!fits(status, grid) || status.longest > kLongestInOrder) return;
  for (std::uint64_t cell = threads.first / kLanes; cell < cells.cells; cell += threads.count / kLanes) {
    const std::uint32_t count = cells.counts[cell];
    if (count != 0)
      orderList(plan.grid, grid, frameOf(plan.grid.view, cells.keyOf(plan.tiers, cell)),
                placesOf(cells.sums[cell]) - count, count, lane, lanes, shared);
  }
  finishGrid(plan, grid, cells, status, threads.first, threads.count);
}

}  // namespace innersphere::device
