// Finds candidates: a warp takes a cluster, a lane for each of its spheres, and deals out what these can meet
// to all lanes, so that all have work however long the lists of some cells are.
#pragma once

#include "cuda_device.hpp"

namespace innersphere::device {

/// The list that a sphere of the cluster goes through. A step tests kListStep of its spheres that are `steps`
/// apart, so that lanes with neighbouring steps read neighbouring spheres.
struct alignas(16) Walk {
  float smallest;  ///< see core::Lookup
  unsigned self;   ///< place, with flags
  unsigned shift;  ///< from the step of the warp to the first place in the list, modulo 2^32
  unsigned steps;
};

/// The spheres of the cluster that have a list to go through, as all lanes read them.
struct Walking {
  float4 balls[kWarp];  ///< centre and reach
  Walk walks[kWarp];
};

/// Flags of a walker's place.
constexpr unsigned kFromA = 1u << 31;
constexpr unsigned kSeveral = 1u << 30;  ///< it looks into several cells
constexpr unsigned kPlace = kSeveral - 1;

/// A pair to decide: walker, and where its partner is listed.
using Candidate = uint2;

/// The bits of all lanes.
inline __device__ unsigned anyLane(unsigned bits) {
#if __CUDA_ARCH__ >= 800
  return __reduce_or_sync(kAll, bits);
#else
  for (unsigned step = 1; step < kWarp; step *= 2) bits |= __shfl_xor_sync(kAll, bits, step);
  return bits;
#endif
}

/// A run of spheres to test, in steps of kListStep.
struct List {
  std::uint32_t first, steps;
  unsigned flags;
};

inline __device__ unsigned stepsOf(unsigned count) {
  return (count + core::kListStep - 1) / core::kListStep;
}

inline __device__ core::Cell cellAt(const core::GridView& grid, std::uint64_t key) {
  const auto mask = static_cast<std::uint32_t>((std::uint64_t{1} << (64 - grid.hash_shift)) - 1);
  for (std::uint32_t at = core::hashCell(grid, key);; at = (at + 1) & mask) {
    const uint4 bits = __ldg(reinterpret_cast<const uint4*>(grid.cells + at));
    const std::uint64_t found = static_cast<std::uint64_t>(bits.y) << 32 | bits.x;
    if (bits.w == 0 || found == key) return {found, bits.z, bits.w};
  }
}

/// The cell of a walker that looks into one; false if it may look into several. Beyond the grid there is
/// none.
inline __device__ bool singleCell(const core::GridView& grid, const core::Lookup& lookup,
                                  std::uint64_t& key) {
  constexpr float kEnd = 1 << core::kAxisBits;
  const int tier = core::tierOf(grid, core::levelOf(lookup.smallest));
  const float scale = core::powerOfTwo(-(grid.finest + tier));
  const float x = floorf((lookup.p.x + grid.half.x) * scale) + 1;
  const float y = floorf((lookup.p.y + grid.half.y) * scale) + 1;
  const float z = floorf((lookup.p.z + grid.half.z) * scale) + 1;
  key = core::cellKey(tier, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                      static_cast<std::uint32_t>(z));
  return lookup.reach <= core::reachOf(grid, tier) && fminf(fminf(x, y), z) >= 0 &&
         fmaxf(fmaxf(x, y), z) < kEnd;
}

/// What a walker meets in the cell number `number` of those where it looks, `count` in all.
inline __device__ List listOf(const core::GridView& grid, const core::Lookup& lookup, std::uint32_t number,
                              std::uint32_t& count) {
  std::uint64_t key;
  unsigned flags = 0;
  if (singleCell(grid, lookup, key)) {
    count = 1;
    if (number > 0) return {0, 0, 0};
  } else {
    const core::Cells cells = core::cellsOf(grid, lookup);
    count = cells.count;
    if (number >= count) return {0, 0, 0};
    if (cells.all) return {grid.listed_count, stepsOf(grid.count), 0};  // see Grid::entries
    std::uint32_t at[3];
    cells.coordinates(number, at);
    key = core::cellKey(cells.tier, at[0], at[1], at[2]);
    flags = count > 1 ? kSeveral : 0;
  }
  const core::Cell cell = cellAt(grid, key);
  return {cell.first, stepsOf(cell.count), flags};
}

/// Of a walker that looks into several cells: whether a partner counts in this one.
inline __device__ bool countsHere(const core::GridView& grid, const core::Lookup& lookup,
                                  std::uint32_t number, const Sphere& partner) {
  const core::Cells cells = core::cellsOf(grid, lookup);
  std::uint32_t at[3];
  cells.coordinates(number, at);
  return core::countsIn(grid, cells, at, partner);
}

/// The lists of a warp, one after the other: a step is in the list that begins last before it.
struct Lists {
  unsigned begin;  ///< of this lane's list
  bool any;        ///< it has one
  unsigned total;  ///< steps

  /// The number, of those that have a list, of the lane whose step is this lane's. All lanes call it; `first`
  /// is the step of lane 0.
  __device__ unsigned ownerOf(unsigned first, unsigned lane) const {
    const unsigned before = __popc(__ballot_sync(kAll, any && begin < first));
    const unsigned ahead = begin - first;
    const unsigned starts = anyLane(any && ahead < kWarp ? 1u << ahead : 0);
    return before + __popc(starts & ((2u << lane) - 1)) - 1;
  }
};

/// Puts the lists of all lanes into a row, with their walkers, those that have one, in `walking`.
inline __device__ Lists lineUp(const core::Lookup& lookup, const List& list, unsigned self, unsigned lane,
                               Walking& walking) {
  const unsigned scanned = scan(list.steps, lane);
  const unsigned owners = __ballot_sync(kAll, list.steps != 0);
  const Lists lists{scanned - list.steps, list.steps != 0, __shfl_sync(kAll, scanned, kWarp - 1)};
  __syncwarp();
  if (lists.any) {
    const unsigned to = __popc(owners & ((1u << lane) - 1));
    walking.balls[to] = {lookup.p.x, lookup.p.y, lookup.p.z, lookup.reach};
    walking.walks[to] = {lookup.smallest, self | list.flags, list.first - lists.begin, list.steps};
  }
  __syncwarp();
  return lists;
}

/// The candidates of a warp that wait to be decided. Most clusters have fewer.
constexpr unsigned kQueue = 288;
using Queue = Candidate[kQueue];

/// Whether there is room for what one round may add.
inline __device__ bool isFull(unsigned queued) {
  return queued + kWarp * core::kListStep > kQueue;
}

/// One round, for which there is room in the queue: each lane tests a step. `number` is that of the cell of
/// walkers that look into several. All lanes call it.
inline __device__ void testStep(const Grid& grid, const Lists& lists, std::uint32_t number, unsigned first,
                                unsigned lane, const Walking& walking, Queue& queue, unsigned& queued) {
  const unsigned owner = lists.ownerOf(first, lane);
  unsigned met = 0, at = 0, self = 0, steps = 0;
  if (first + lane < lists.total) {
    const float4 ball = walking.balls[owner];
    const Walk walk = walking.walks[owner];
    self = walk.self;
    steps = walk.steps;
    at = walk.shift + first + lane;
    const core::Lookup lookup{{ball.x, ball.y, ball.z}, ball.w, walk.smallest};
    const Sphere* entry = grid.entries + at;
    const std::size_t apart = steps;
#pragma unroll
    for (unsigned k = 0; k < core::kListStep; ++k, entry += apart) {
      if (core::meets(lookup, load(entry))) met |= 1u << k;
    }
    if (met != 0 && self & kSeveral) {
      for (unsigned k = 0; k < core::kListStep; ++k) {
        if ((met >> k & 1) != 0 &&
            !countsHere(grid.view, lookup, number, load(grid.entries + at + k * steps)))
          met ^= 1u << k;
      }
    }
  }
  while (true) {
    const unsigned finders = __ballot_sync(kAll, met != 0);
    if (finders == 0) break;
    if (met != 0) {
      const unsigned k = static_cast<unsigned>(__ffs(static_cast<int>(met)) - 1);
      queue[queued + __popc(finders & ((1u << lane) - 1))] = {self, at + k * steps};
      met &= met - 1;
    }
    queued += __popc(finders);
  }
  __syncwarp();
}

}  // namespace innersphere::device
