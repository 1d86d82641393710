// Declares what the kernels of a query read and write, in the memory of a device.
#pragma once

#include <cuda_runtime.h>

#include <cstdint>

#include "core/sums.hpp"
#include "core/traversal.hpp"

namespace innersphere::device {

constexpr unsigned kWarp = 32;
constexpr unsigned kAll = 0xffffffffu;
static_assert(core::kClusterSize == kWarp, "a warp walks one cluster");
constexpr unsigned kGroup = 32;        ///< clusters under one ball
constexpr unsigned kTaskClusters = 8;  ///< neighbouring clusters in a task, which a warp takes from a batch

/// Holds two neighbours in a list, as halves, the first one's below: see half_spheres.hpp.
struct alignas(16) EntryPair {
  unsigned x, y, z, radius;
};

/// Holds a grid, with what only kernels read.
struct alignas(16) Grid {
  core::GridView view;
  /// The spheres of view.listed. After them come all spheres in their order, for query spheres that look at
  /// all, and some that meet nothing.
  const EntryPair* entries;
  const Sphere* groups;         ///< balls around kGroup clusters each
  const std::uint32_t* places;  ///< of the packing's spheres in the grid
};

/// Describes one pair of bodies: core::Setup without the grids. Of arrays, the first is A's.
struct alignas(16) Query {
  core::Frame frame;
  core::Search searches[2];  ///< of that body's spheres in the grid of the other
  core::Units units;
  std::uint32_t clusters[2];
  const Grid* grids[2];
};

/// Holds a query with its grids, where a warp reads it fast.
struct Scene {
  Query query;
  Grid grids[2];
};

/// Holds the sum of one term as three numbers that any number of warps can add to without a carry between
/// them.
struct Limbs {
  unsigned long long fine;         ///< in units of the quantum
  unsigned long long coarse_low;   ///< in units of 2^fine_bits quanta
  unsigned long long coarse_high;  ///< in units of 2^(fine_bits + 32)
};

struct DeviceSums {
  unsigned long long pairs;
  Limbs terms[core::kTerms];
};
constexpr unsigned kSumWords = sizeof(DeviceSums) / sizeof(unsigned long long);

/// Counts for the kernels of one batch; all are zero before each.
struct Counters {
  unsigned tasks;            ///< of Batch::tasks
  unsigned taken;            ///< of these
  unsigned blocks;           ///< that are done
  unsigned long long found;  ///< overlapping pairs, also those beyond the capacity
};

constexpr unsigned kResultWords = sizeof(core::Totals) / sizeof(unsigned long long);

/// Holds what the host watches, in its own memory.
struct HostSignal {
  /// The result of a single query and the number of its overlapping pairs, as 32-bit halves of words, each
  /// below the number of its run. So every half says by itself that it has come, and none has to wait for
  /// another.
  unsigned long long halves[2 * (kResultWords + 1)];
  /// The number of the last batch that is done, and its overlapping pairs.
  unsigned done;
  unsigned long long found;
};

/// Holds the arguments of the launches; pointers are to the device.
struct Batch {
  const Query* queries;
  unsigned count;
  DeviceSums* sums;  ///< zero before, and again after a single query
  Counters* counters;
  unsigned long long*
      tasks;  ///< active clusters of all queries, kTaskClusters neighbours in each: see packTask()
  /// Pairs of overlapping spheres: number of the query, sphere of A, sphere of B, so many bits each. Null if
  /// they are not wanted.
  unsigned long long* found_pairs;
  unsigned long long capacity;
  unsigned bits_a, bits_b;
  HostSignal* signal;
  core::Totals* results;  ///< in the memory of the host; unused by a single query
  unsigned run;
};

constexpr unsigned kMostQueries = 1u << 14;  ///< in one batch

/// Says what is computed.
enum class Goal { touch, volume, wrench };

}  // namespace innersphere::device
