// Declares what the kernels of a query read and write, in the memory of a device.
#pragma once

#include <cuda_runtime.h>

#include <cstdint>

#include "core/poses.hpp"
#include "core/sums.hpp"
#include "innersphere/overlap.hpp"

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

/// Describes one pair of bodies. Of arrays, the first is A's.
struct alignas(16) Query : core::PairSetup {
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
constexpr unsigned kSumCopies = 8;  ///< that the blocks of a single query add to

/// Counts for the kernels of one batch; all are zero before each.
struct Counters {
  unsigned tasks;            ///< of Batch::tasks
  unsigned taken;            ///< of these
  unsigned blocks;           ///< that are done
  unsigned fault;            ///< the first of a sweep: see packFault()
  unsigned long long found;  ///< overlapping pairs, also those beyond the capacity
};

/// Packs what is wrong with a pose of a part, so that the first one has the greatest number; 0 is no fault.
INNERSPHERE_HD inline unsigned packFault(core::Fault fault, unsigned number) {
  return fault == core::Fault::none ? 0 : ~number << 3 | static_cast<unsigned>(fault);
}
INNERSPHERE_HD inline core::Fault faultOf(unsigned packed) {
  return static_cast<core::Fault>(packed & 7);
}
/// Returns the number of the pose that a fault is of.
INNERSPHERE_HD inline unsigned poseOf(unsigned packed) {
  return ~packed >> 3;
}

constexpr unsigned kResultWords = sizeof(core::Totals) / sizeof(unsigned long long);
static_assert(sizeof(Overlap) == sizeof(core::Totals),
              "an overlap has a word for each of its totals, in their order");

/// Holds what the host watches, in its own memory.
struct HostSignal {
  /// The result of a single query and the number of its overlapping pairs, as 32-bit halves of words, each
  /// below the number of its run. So every half says by itself that it has come, and none has to wait for
  /// another.
  unsigned long long halves[2 * (kResultWords + 1)];
  /// The number of the last batch that is done, and its overlapping pairs.
  unsigned done;
  unsigned fault;               ///< the first one since the host has cleared it
  unsigned long long in_poses;  ///< where the part begins that it is in
  unsigned long long found;
  unsigned left;  ///< the number of the last resident kernel that has left
};

/// Halves of a question: what is to be done, and the words of the query. As HostSignal::halves, each is below
/// the number of its run.
constexpr unsigned kQuestionHalves = 1 + sizeof(Query) / sizeof(unsigned);
constexpr unsigned kAsk = 0, kLeave = 1;
constexpr unsigned kRelays = 8;  ///< copies of a question for the blocks of a resident kernel

/// Holds where a resident kernel finds questions about two models.
struct Mailbox {
  const Grid* grids[2];
  const unsigned long long* question;  ///< in memory of the host
  unsigned long long* relay;           ///< kRelays questions, none of them of a run to come
  unsigned number;                     ///< of the kernel, from 1 on
  unsigned long long idle;             ///< so long the kernel waits for the next question [ns]
};

/// Holds the arguments of the launches; pointers are to the device.
struct Batch {
  const Query* queries;
  unsigned count;
  DeviceSums* sums;  ///< of a single query kSumCopies, which are zero before, and again after it
  Counters* counters;
  unsigned long long*
      tasks;  ///< active clusters of all queries, kTaskClusters neighbours in each: see packTask()
  /// Pairs of overlapping spheres: number of the query, sphere of A, sphere of B, so many bits each. Null if
  /// they are not wanted.
  unsigned long long* found_pairs;
  unsigned long long capacity;
  unsigned bits_a, bits_b;
  HostSignal* signal;
  core::Totals* results;          ///< in the memory of the host; unused by a single query
  Overlap* overlaps;              ///< of a sweep, which has these in place of results; else null
  unsigned long long first_pose;  ///< of a sweep
  unsigned run;
};

constexpr unsigned kMostQueries = 1u << 14;  ///< in one batch

/// Says what is computed.
enum class Goal { touch, volume, wrench };

}  // namespace innersphere::device
