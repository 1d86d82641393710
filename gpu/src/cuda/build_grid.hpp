// Declares what the kernels that build a grid read and write. The build has the paper's steps: give each
// sphere its level and its place on a curve, sort by these, count what each cell will list, sum the counts up
// to where each list begins, fill the lists, and hash the cells.
#pragma once

#include "core/grid_level.hpp"
#include "cuda/batch.hpp"
#include "cuda/memory.hpp"

namespace innersphere::device {

/// Holds all grid levels of a grid; their cells are numbered through.
struct GridLevels {
  core::GridLevel of[core::kMostLevels];
  std::uint64_t first[core::kMostLevels + 1];  ///< cell of each; after the last: how many there are
  int count;
};

/// Says what each warp does. A warp takes a cluster and a grid level, or a slice of that: large spheres are
/// in many cells. The largest come first, as they take longest.
struct ListTasks {
  unsigned end[core::kMostLevels];  ///< of the tasks of each level and of all above it
  unsigned of_cluster[core::kMostLevels];
  unsigned first_cluster[core::kMostLevels];
  unsigned in_cluster[core::kMostLevels];  ///< spheres, at most
  /// Cells near a sphere, at most, by how many levels its own is above the first one that the grid level
  /// lists.
  unsigned cells_near[core::kMostLevels];
  unsigned all;

  __host__ __device__ unsigned slices(int level, int above) const {
    constexpr unsigned kCellsOfASlice = 512;
    const unsigned full = in_cluster[level] * cells_near[above] / kCellsOfASlice;
    return full > 1 ? full : 1;
  }
};

/// Describes the buckets of spheres. Spheres of one level whose places on the curve have the same upper bits
/// come into one bucket first. Each level has about as many of them as spheres.
struct Buckets {
  std::uint32_t first[core::kMostLevels];
  int shift[core::kMostLevels];  ///< of a place on the curve
  std::uint32_t all;
};

struct BuildPlan {
  core::GridPlan grid;
  GridLevels grid_levels;
  ListTasks list_tasks;
  Buckets buckets;
};

/// Returns true if all grid levels may have a counter for each cell.
bool isDense(const BuildPlan& plan);
BuildPlan makeBuildPlan(const core::GridPlan& plan);

/// Holds the arrays of a grid, and for how much there is room.
struct GridArrays {
  Sphere* spheres;
  std::uint32_t* ids;
  std::uint32_t* places;
  core::Cluster* clusters;
  Sphere* groups;
  core::Cell* cells;
  std::uint32_t* listed;
  EntryPair* entries;
  Grid* header;
  std::uint64_t listed_room;
  std::uint64_t table_room;  ///< a power of two
};

/// Tells the host what a build finds out.
struct BuildStatus {
  std::uint64_t cells;   ///< with a list
  std::uint64_t listed;  ///< places, with what fills up the lists
  unsigned longest;      ///< list
};

/// Returns the size of a table that is at most half full.
__host__ __device__ inline std::uint64_t tableSizeFor(std::uint64_t cells) {
#if defined(__CUDA_ARCH__)
  return std::uint64_t{1} << (64 - __clzll(static_cast<long long>(2 * cells - 1)));
#else
  std::uint64_t size = 1;
  while (size < 2 * cells) size *= 2;
  return size;
#endif
}

__host__ __device__ inline bool fits(const BuildStatus& status, const GridArrays& arrays) {
  return status.listed <= arrays.listed_room && tableSizeFor(status.cells) <= arrays.table_room;
}

/// Lists longer than this are put in order by sorting them all.
constexpr unsigned kLongestInOrder = 256;

/// Holds device memory that is only needed while a grid is built.
struct BuildScratch {
  DeviceArray<Sphere> given;              ///< in the order of the packing
  DeviceArray<std::uint64_t> keys[2];     ///< of spheres, or of cells
  DeviceArray<std::uint32_t> numbers[2];  ///< that go with them
  DeviceArray<std::uint32_t> in_buckets;  ///< spheres; zero before a build and after it
  DeviceArray<std::uint32_t> counts;      ///< of what cells list; the longest list
  DeviceArray<std::uint32_t> starts;      ///< of buckets, or of cells in what was sorted
  DeviceArray<std::uint64_t> sums;        ///< of counts; see packed()
  DeviceArray<core::Cell> used;           ///< cells with a list
  DeviceArray<std::uint64_t> block_sums;
  DeviceArray<unsigned long long> found;  ///< pairs of a cell and a sphere that it lists
  DeviceArray<std::byte> cub;
  PinnedArray<BuildStatus> status;
  unsigned most_blocks = 0;  ///< that run side by side
};

/// Says what a launch does.
struct BuildSteps {
  bool order;  ///< puts the spheres in order, with their clusters, and clears the table
  bool count;  ///< counts what cells list and makes their lists; where not all fits it only tells the status
};

/// Launches steps of a build. Dense grid levels take both steps, and once more without the first when there
/// is room. Others take the first.
void launchBuild(const BuildPlan& plan, const GridArrays& grid, const Sphere* given, BuildSteps steps,
                 BuildScratch& scratch, cudaStream_t stream);

/// Makes the lists of any grid levels by sorting. The first step waits for the device and gives the status;
/// then room must be made.
BuildStatus sortLists(const BuildPlan& plan, const GridArrays& arrays, BuildScratch& scratch,
                      cudaStream_t stream);
void launchSorted(const BuildPlan& plan, const GridArrays& arrays, const BuildStatus& status,
                  BuildScratch& scratch, cudaStream_t stream);

/// Returns how many entries follow the lists: pairs of all spheres, and of none for steps that go beyond the
/// end.
__host__ __device__ inline std::size_t entriesOfAll(std::uint32_t spheres) {
  return core::padded(spheres) / 2 + 4;
}

__host__ __device__ inline std::size_t groupCount(std::size_t clusters) {
  return (clusters + kGroup - 1) / kGroup;
}

}  // namespace innersphere::device
