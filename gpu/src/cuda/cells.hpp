// Finds, with a warp, which cells list the spheres of a cluster.
#pragma once

#include "cuda/build_grid.hpp"
#include "cuda/warp.hpp"

namespace innersphere::device {

/// Names a cluster and a grid level for a warp, or a slice of these.
struct ListTask {
  unsigned cluster, slice, slices;
  int grid_level;
  std::uint32_t first, count;  ///< spheres
};

inline __device__ ListTask listTask(const BuildPlan& plan, unsigned number) {
  const ListTasks& tasks = plan.list_tasks;
  ListTask task;
  int level = plan.grid.levels - 1;
  while (number >= tasks.end[level]) --level;
  const unsigned at = number - (level + 1 < plan.grid.levels ? tasks.end[level + 1] : 0);
  const unsigned of_level = at / tasks.of_cluster[level];
  task.cluster = tasks.first_cluster[level] + of_level;
  task.first = plan.grid.level_first[level] + of_level * core::kClusterSize;
  task.count = min(core::kClusterSize, plan.grid.level_first[level + 1] - task.first);
  task.slice = at % tasks.of_cluster[level];
  for (task.grid_level = 0;; ++task.grid_level) {
    task.slices = tasks.slices(level, plan.grid.levelsAbove(level, task.grid_level));
    if (task.slice < task.slices) return task;
    task.slice -= task.slices;
  }
}

constexpr unsigned kTogether = 8;  ///< cells that a lane looks at together
constexpr unsigned kBoxCells = 512;

/// Holds what a warp shares while it looks at cells.
struct WarpCells {
  core::CellsNear near[kWarp];
  std::uint32_t counts[kBoxCells];  ///< of the cells of a box; zero between uses

  __device__ void clear(unsigned lane) {
    for (unsigned i = lane; i < kBoxCells; i += kWarp) counts[i] = 0;
    __syncwarp();
  }
};

/// Holds some cells near one sphere.
template <typename Cell>
struct SomeCells {
  Cell cells[kTogether];
  std::uint32_t in_box[kTogether];  ///< their numbers there; see CellBoxOfWarp
  unsigned mask;                    ///< a bit for each that lists the sphere
  std::uint32_t place;              ///< of the sphere
};

/// Holds the cells near all spheres of a warp.
struct CellBoxOfWarp {
  int lo[3], size[3];
  bool fits;  ///< has no more than kBoxCells

  /// Finds the box; all lanes call it.
  __device__ CellBoxOfWarp(const core::CellsNear& near, bool valid) {
    constexpr int kNone = -(1 << 30);
    float cells = 1;
#pragma unroll
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis] = -maximum(valid ? -static_cast<int>(near.lo[axis]) : kNone);
      size[axis] = maximum(valid ? static_cast<int>(near.hi[axis]) : kNone) - lo[axis] + 1;
      cells *= static_cast<float>(size[axis]);
    }
    fits = cells <= kBoxCells;
  }
};

/// Looks at kTogether cells near a sphere, from number `from` on.
template <typename Cell>
__device__ __forceinline__ void lookAt(const core::GridLevel& grid_level, const core::CellsNear& near,
                                       const CellBoxOfWarp& box, unsigned from, SomeCells<Cell>& some) {
  const std::uint32_t nx = near.hi[0] - near.lo[0] + 1, ny = near.hi[1] - near.lo[1] + 1, row = from / nx;
  std::uint32_t x = near.lo[0] + from % nx, y = near.lo[1] + row % ny, z = near.lo[2] + row / ny;
  some.mask = 0;
#pragma unroll
  for (unsigned k = 0; k < kTogether; ++k) {
    some.cells[k] = (static_cast<Cell>(z) * grid_level.size[1] + y) * grid_level.size[0] + x;
    some.in_box[k] = ((z - box.lo[2]) * box.size[1] + y - box.lo[1]) * box.size[0] + x - box.lo[0];
    if (z <= near.hi[2] && !near.isFar(x, y, z)) some.mask |= 1u << k;
    const bool next_row = ++x > near.hi[0];
    x = next_row ? near.lo[0] : x;
    y += next_row ? 1 : 0;
    const bool next_layer = y > near.hi[1];
    y = next_layer ? near.lo[1] : y;
    z += next_layer ? 1 : 0;
  }
}

/// Calls f(some, whether the box of all of them fits) for all cells of the task's grid level that list one of
/// its spheres, kTogether at a time; all lanes call f together. `sphere` is the lane's, relative to the
/// centre. Lanes share all cells, as some spheres are in many.
template <typename Cell, typename F>
__device__ void forCells(const GridLevels& grid_levels, const ListTask& task, const Sphere& sphere,
                         unsigned lane, core::CellsNear (&shared)[kWarp], const F& f) {
  const core::GridLevel& grid_level = grid_levels.of[task.grid_level];
  unsigned calls = 0;
  core::CellsNear near{};
  __syncwarp();
  if (lane < task.count && task.first + lane >= grid_level.first_place) {
    near = grid_level.near(sphere);
    unsigned cells = 1;
    for (int axis = 0; axis < 3; ++axis) cells *= near.hi[axis] - near.lo[axis] + 1;
    calls = (cells + kTogether - 1) / kTogether;
    shared[lane] = near;
  }
  const CellBoxOfWarp box(near, calls > 0);
  const unsigned scanned = scan(calls), begin = scanned - calls;
  const unsigned total = __shfl_sync(kAll, scanned, kWarp - 1);
  __syncwarp();
  for (unsigned all = task.slice * kWarp; all < total; all += task.slices * kWarp) {
    const unsigned at = all + lane;
    unsigned owner = 0;
#pragma unroll
    for (unsigned step = kWarp / 2; step > 0; step /= 2) {
      if (__shfl_sync(kAll, begin, owner + step) <= at) owner += step;
    }
    const unsigned first = __shfl_sync(kAll, begin, owner);
    SomeCells<Cell> some;
    some.place = task.first + owner;
    if (at < total) {
      lookAt(grid_level, shared[owner], box, kTogether * (at - first), some);
    } else {
      some.mask = 0;
    }
    f(some, box.fits);
  }
}

/// Calls f(k) for those cells that count.
template <typename Cell, typename F>
__device__ __forceinline__ void forSome(const SomeCells<Cell>& some, const F& f) {
#pragma unroll
  for (unsigned k = 0; k < kTogether; ++k) {
    if ((some.mask >> k & 1) != 0) f(k);
  }
}

}  // namespace innersphere::device
