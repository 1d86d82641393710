// Finds candidates: a warp takes a cluster, a lane for each of its spheres, and deals out what these can meet
// to all lanes, so that all have work however long the lists of some cells are.
#pragma once

#include "cuda/half_spheres.hpp"
#include "cuda/warp.hpp"

namespace innersphere::device {

/// Describes the list that a sphere of the cluster goes through. A step tests up to kStepPairs pairs of its
/// spheres that are `steps` apart, so that lanes with neighbouring steps read neighbours.
struct ListTraversal {
  struct alignas(16) Sphere {
    HalfQuerySphere query_sphere;
    unsigned self;  ///< place, with flags
  };
  struct alignas(16) Range {
    unsigned shift;  ///< from the step of the warp to the first pair in the list, modulo 2^32
    unsigned steps;
    unsigned end;  ///< of the list's pairs
  };
};
constexpr unsigned kStepPairs = 4;  ///< see entriesOfAll()

/// Holds the spheres of the cluster that have a list to go through, as all lanes read them.
struct ListTraversals {
  ListTraversal::Sphere spheres[kWarp];  ///< apart from their ranges: lanes use different banks
  ListTraversal::Range ranges[kWarp];
  core::Lookup lookups[kWarp];  ///< of those that look into several cells
};

/// These are flags of a query sphere's place.
constexpr unsigned kFromA = 1u << 31;
constexpr unsigned kSeveral = 1u << 30;  ///< it looks into several cells
constexpr unsigned kPlace = kSeveral - 1;

/// Names a pair to decide: the query sphere, and where its partner is listed.
using Candidate = uint2;

/// Returns the bits that any lane has.
inline __device__ unsigned anyLane(unsigned bits) {
#if __CUDA_ARCH__ >= 800
  return __reduce_or_sync(kAll, bits);
#else
  for (unsigned step = 1; step < kWarp; step *= 2) bits |= __shfl_xor_sync(kAll, bits, step);
  return bits;
#endif
}

/// Holds pairs of spheres to test.
struct List {
  std::uint32_t first, count;
  unsigned flags;
  HalfQuerySphere query_sphere;
};

inline __device__ unsigned pairsOf(unsigned spheres) {
  return core::padded(spheres) / 2;
}

inline __device__ core::Cell cellAt(const core::GridView& grid, std::uint64_t key) {
  const auto mask = static_cast<std::uint32_t>((std::uint64_t{1} << (64 - grid.hash_shift)) - 1);
  for (std::uint32_t at = core::hashCell(grid, key);; at = (at + 1) & mask) {
    const uint4 bits = __ldg(reinterpret_cast<const uint4*>(grid.cells + at));
    const std::uint64_t found = static_cast<std::uint64_t>(bits.y) << 32 | bits.x;
    if (bits.w == 0 || found == key) return {found, bits.z, bits.w};
  }
}

/// Returns what a query sphere meets in the cell number `number` of those where it looks, `count` in all.
/// Nearly all look into one; beyond the grid there is none.
inline __device__ List listOf(const core::GridView& grid, const core::Lookup& lookup, std::uint32_t number,
                              std::uint32_t& count) {
  constexpr float kEnd = 1 << core::kAxisBits;
  int grid_level = core::gridLevelOf(grid, core::levelOf(lookup.smallest));
  const float scale = core::powerOfTwo(-(grid.finest + grid_level));
  Vec3f cell{floorf((lookup.p.x + grid.half.x) * scale) + 1, floorf((lookup.p.y + grid.half.y) * scale) + 1,
             floorf((lookup.p.z + grid.half.z) * scale) + 1};
  List list{};
  if (lookup.reach <= core::reachOf(grid, grid_level) && fminf(fminf(cell.x, cell.y), cell.z) >= 0 &&
      fmaxf(fmaxf(cell.x, cell.y), cell.z) < kEnd) {
    count = 1;
    if (number > 0) return {};
  } else {
    const core::Cells cells = core::cellsOf(grid, lookup);
    count = cells.count;
    if (number >= count) return {};
    if (cells.all)  // see Grid::entries
      return {grid.listed_count / 2, pairsOf(grid.count), 0,
              makeHalfQuerySphere(grid, frameOfAll(grid), lookup)};
    std::uint32_t at[3];
    cells.coordinates(number, at);
    cell = {static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2])};
    grid_level = cells.grid_level;
    list.flags = count > 1 ? kSeveral : 0;
  }
  list.query_sphere = makeHalfQuerySphere(grid, frameOf(grid, grid_level, cell), lookup);
  const core::Cell found =
      cellAt(grid, core::cellKey(grid_level, static_cast<std::uint32_t>(cell.x),
                                 static_cast<std::uint32_t>(cell.y), static_cast<std::uint32_t>(cell.z)));
  list.first = found.first / 2;
  list.count = pairsOf(found.count);
  return list;
}

/// Returns true if the partner of a query sphere that looks into several cells, at this place of a list,
/// counts in this one.
inline __device__ bool countsHere(const core::GridView& grid, const core::Lookup& lookup,
                                  std::uint32_t number, std::uint32_t listed) {
  const core::Cells cells = core::cellsOf(grid, lookup);
  std::uint32_t at[3];
  cells.coordinates(number, at);
  const Sphere s = load(grid.spheres + __ldg(grid.listed + listed));
  return core::countsIn(grid, cells, at,
                        {s.x - grid.centre.x, s.y - grid.centre.y, s.z - grid.centre.z, s.radius});
}

/// Holds the lists of a warp, one after the other: a step is in the list that begins last before it.
struct Lists {
  unsigned begin;  ///< of this lane's list
  bool any;        ///< it has one
  unsigned total;  ///< steps

  /// Returns the number, of those that have a list, of the lane whose step is this lane's. All lanes call it;
  /// `first` is the step of lane 0.
  __device__ unsigned ownerOf(unsigned first, unsigned lane) const {
    const unsigned before = __popc(__ballot_sync(kAll, any && begin < first));
    const unsigned ahead = begin - first;
    const unsigned starts = anyLane(any && ahead < kWarp ? 1u << ahead : 0);
    return before + __popc(starts & ((2u << lane) - 1)) - 1;
  }
};

/// Puts the lists of all lanes into a row, with their query spheres, those that have one, in `traversals`.
inline __device__ Lists lineUp(const core::Lookup& lookup, const List& list, unsigned self, unsigned lane,
                               ListTraversals& traversals) {
  const unsigned steps = (list.count + kStepPairs - 1) / kStepPairs;
  const unsigned scanned = scan(steps);
  const unsigned owners = __ballot_sync(kAll, steps != 0);
  const Lists lists{scanned - steps, steps != 0, __shfl_sync(kAll, scanned, kWarp - 1)};
  __syncwarp();
  if (lists.any) {
    const unsigned to = __popc(owners & ((1u << lane) - 1));
    storeWords(traversals.spheres[to], {list.query_sphere, self | list.flags});
    storeWords(traversals.ranges[to], {list.first - lists.begin, steps, list.first + list.count});
    if (list.flags & kSeveral) traversals.lookups[to] = lookup;
  }
  __syncwarp();
  return lists;
}

/// So many candidates of a warp can wait to be decided. Most clusters have fewer.
constexpr unsigned kQueue = 288;
using Queue = Candidate[kQueue];
static_assert(kQueue >= kWarp - 1 + kWarp * 2 * kStepPairs,
              "room for one iteration beside what is left over");

/// Does one iteration: each lane tests a step. `number` is that of the cell of query spheres that look into
/// several. Returns false, and nothing is queued, if there is no room. All lanes call it.
inline __device__ bool testStep(const Grid& grid, const Lists& lists, std::uint32_t number, unsigned first,
                                unsigned lane, const ListTraversals& traversals, Queue& queue,
                                unsigned& queued) {
  const unsigned owner = lists.ownerOf(first, lane);
  const auto pairOfBit = [](unsigned bit) { return 15 - bit % 16; };
  const bool any = first + lane < lists.total;
  const auto sphere = loadWords(traversals.spheres[owner]);
  const auto range = loadWords(traversals.ranges[owner]);
  const unsigned self = sphere.self, end = range.end, steps = any ? range.steps : 0;
  const unsigned at = any ? range.shift + first + lane : end;
  EntryPair pairs[kStepPairs];  // maybe some beyond the end
#pragma unroll
  for (unsigned k = 0; k < kStepPairs; ++k) pairs[k] = load(grid.entries + (at + k * steps));
  __syncwarp();        // all are on their way before the first is used
  unsigned found = 0;  // bit 31 - k: the second of pair k; 15 - k: the first
#pragma unroll
  for (unsigned k = 0; k < kStepPairs; ++k) {
    const unsigned both = met(sphere.query_sphere, pairs[k]) >> k;
    if (at + k * steps < end) found |= both;
  }
  if (found != 0 && self & kSeveral) {
    for (unsigned left = found; left != 0; left &= left - 1) {
      const auto bit = static_cast<unsigned>(__ffs(static_cast<int>(left)) - 1);
      const unsigned listed = 2 * (at + pairOfBit(bit) * steps) + bit / 16;
      if (!countsHere(grid.view, traversals.lookups[owner], number, listed)) found ^= 1u << bit;
    }
  }
  const unsigned mine = __popc(found), before = scan(mine);
  const unsigned total = __shfl_sync(kAll, before, kWarp - 1);
  if (queued + total > kQueue) return false;
  for (unsigned to = queued + before - mine; found != 0; found &= found - 1, ++to) {
    const auto bit = static_cast<unsigned>(__ffs(static_cast<int>(found)) - 1);
    queue[to] = {self, 2 * (at + pairOfBit(bit) * steps) + bit / 16};
  }
  queued += total;
  __syncwarp();
  return true;
}

}  // namespace innersphere::device
