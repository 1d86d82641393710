// The walk as the device runs it. A warp takes some clusters of one query, one after the other, a lane for
// each sphere. Lanes find candidates at different times, so these are queued, and decided side by side.
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <cstdint>

#include "backend.hpp"
#include "core/sums.hpp"
#include "core/walk.hpp"

namespace innersphere::device {

constexpr unsigned kWarp = 32;
constexpr unsigned kAll = 0xffffffffu;
static_assert(core::kClusterSize == kWarp, "a warp walks one cluster");
constexpr unsigned kLargestJob = 32;         ///< clusters
constexpr unsigned kWarpsPerProcessor = 64;  ///< that there should be, at least
constexpr unsigned kRun = 32;                ///< listed spheres that a lane tests before it queues candidates
static_assert(kRun % core::kListStep == 0, "whole steps of a list");
constexpr unsigned kQueue = 2 * kWarp;                               ///< candidates
constexpr unsigned kRoundsPerSum = 1u << (core::kShortSumBits - 5);  ///< each of which adds a warp's terms
static_assert(kRoundsPerSum > 2 * kRun, "a run adds up to kRun + 1 rounds");
constexpr std::uint32_t kFromA = 1u << 31;  ///< of a candidate's walker

/// The sum of one term as three numbers that any number of warps can add to without a carry between them.
struct Limbs {
  unsigned long long fine;         ///< in units of the quantum
  unsigned long long coarse_low;   ///< in units of 2^fine_bits quanta
  unsigned long long coarse_high;  ///< in units of 2^(fine_bits + 32)
};

struct DeviceSums {
  unsigned long long pairs;
  Limbs terms[core::kTerms];
};

inline void toSums(const DeviceSums& from, const core::Units& units, core::Sums& to) {
  to.pairs = from.pairs;
  for (int i = 0; i < core::kTerms; ++i) {
    const Limbs& limbs = from.terms[i];
    const int bits = unitOf(units, i).fine_bits;
    const auto part = [](unsigned long long x, int shift) {
      const core::FixedSum low = core::shifted(static_cast<std::int64_t>(x), shift % 64);
      return shift < 64 ? low : core::FixedSum{0, low.lo};
    };
    to.terms[i] = part(limbs.fine, 0) + part(limbs.coarse_low, bits) + part(limbs.coarse_high, bits + 32);
  }
}

/// Arguments of the launch; pointers to the device.
struct Batch {
  const core::Setup* setups;
  const unsigned long long* first;  ///< jobs of all queries before each
  unsigned count;
  unsigned job_size;  ///< clusters
  DeviceSums* sums;
  Hit* hits;
  unsigned long long capacity;  ///< of hits
  unsigned long long* found;    ///< hits, also those beyond the capacity; null if none are wanted
};

/// What a launch computes.
enum class Goal { touch, volume, wrench };

template <Goal goal>
constexpr int kTermCount = goal == Goal::wrench   ? core::kTerms
                           : goal == Goal::volume ? core::kVolumeTerms
                                                  : 1;

/// What a warp works on.
struct Job {
  unsigned query;
  std::uint32_t first;  ///< cluster, of all of A's and then all of B's
};

inline __device__ Job findJob(const Batch& batch) {
  // Often all queries have as many jobs, and this is the one.
  unsigned lo = static_cast<unsigned>(static_cast<unsigned long long>(blockIdx.x) * batch.count / gridDim.x);
  if (blockIdx.x < batch.first[lo] || blockIdx.x >= batch.first[lo + 1]) {
    lo = 0;
    for (unsigned hi = batch.count; hi - lo > 1;) {
      const unsigned middle = lo + (hi - lo) / 2;
      (batch.first[middle] <= blockIdx.x ? lo : hi) = middle;
    }
  }
  return {lo, static_cast<std::uint32_t>(blockIdx.x - batch.first[lo]) * batch.job_size};
}

constexpr int kPass = 4;                          ///< terms that the lanes exchange at once
constexpr unsigned kShare = kWarp / (2 * kPass);  ///< lanes that sum one column

/// Memory of one warp.
struct Scratch {
  uint2 queue[kQueue];  ///< candidates: places of walker and partner
  /// Coarse and fine parts of some terms, a row for each lane; kShare more, so that lanes read different
  /// banks.
  unsigned long long columns[2 * kPass][kWarp + kShare];
};

/// The sums of a warp, spread over its lanes to take few registers: those from kShare i on hold column i of
/// each pass, each the sum of every kShare-th row.
template <int kTerms>
struct WarpSums {
  static constexpr int kPasses = (kTerms + kPass - 1) / kPass;
  unsigned long long parts[kPasses];
  unsigned pairs;  ///< of this lane
  __device__ void clear() {
    pairs = 0;
#pragma unroll
    for (int pass = 0; pass < kPasses; ++pass) parts[pass] = 0;
  }
};

/// Adds one pair of each lane.
template <int kTerms>
inline __device__ void addTerms(const core::Terms& terms, const core::Units& units, Scratch& scratch,
                                unsigned lane, WarpSums<kTerms>& sums) {
#pragma unroll
  for (int pass = 0; pass < WarpSums<kTerms>::kPasses; ++pass) {
#pragma unroll
    for (int i = 0; i < kPass; ++i) {
      const int term = pass * kPass + i;
      core::ShortSum sum{0, 0};
      if (term < kTerms) core::add(sum, terms.terms[term], unitOf(units, term));
      scratch.columns[2 * i][lane] = sum.coarse;
      scratch.columns[2 * i + 1][lane] = sum.fine;
    }
    __syncwarp();
#pragma unroll
    for (unsigned row = lane % kShare; row < kWarp; row += kShare)
      sums.parts[pass] += scratch.columns[lane / kShare][row];
    __syncwarp();
  }
}

/// Adds the sums of the warp to those of the query, and clears them.
template <int kTerms>
inline __device__ void addWarp(DeviceSums& total, const core::Units& units, WarpSums<kTerms>& sums,
                               unsigned lane) {
  unsigned pairs = sums.pairs;
  for (unsigned step = kWarp / 2; step > 0; step /= 2) pairs += __shfl_xor_sync(kAll, pairs, step);
  if (pairs == 0) return;
  if (lane == 0) atomicAdd(&total.pairs, static_cast<unsigned long long>(pairs));
#pragma unroll
  for (int pass = 0; pass < WarpSums<kTerms>::kPasses; ++pass) {
    unsigned long long sum = sums.parts[pass];
    for (unsigned step = 1; step < kShare; step *= 2) sum += __shfl_xor_sync(kAll, sum, step);
    const unsigned long long partner = __shfl_xor_sync(kAll, sum, kShare);
    const unsigned column = lane / kShare;
    const int term = pass * kPass + static_cast<int>(column / 2);
    if (lane % kShare != 0 || term >= kTerms) continue;
    Limbs& limbs = total.terms[term];
    const int bits = unitOf(units, term).fine_bits;
    if (column % 2 == 1) {
      atomicAdd(&limbs.fine, sum & ((1ull << bits) - 1));
      continue;
    }
    const long long coarse = static_cast<long long>(sum) + (static_cast<long long>(partner) >> bits);
    atomicAdd(&limbs.coarse_low, static_cast<unsigned long long>(coarse) & 0xffffffffu);
    atomicAdd(&limbs.coarse_high, static_cast<unsigned long long>(coarse >> 32));
  }
  sums.clear();
}

/// Decides one candidate. If it counts, gives its terms and returns true.
template <Goal goal>
inline __device__ bool decide(const Batch& batch, const core::Setup& setup, unsigned query, uint2 candidate,
                              core::Terms& terms) {
  const bool from_a = candidate.x & kFromA;
  const std::uint32_t walker = candidate.x & ~kFromA;
  const std::uint32_t ia = from_a ? walker : candidate.y, ib = from_a ? candidate.y : walker;
  const core::Pair pair = core::makePair(setup.frame, setup.a.grid.spheres[ia], setup.b.grid.spheres[ib]);
  if (!core::isHit(pair, from_a)) return false;
  if (goal == Goal::touch) return true;
  terms = core::makeTerms<goal == Goal::wrench>(pair);
  if (goal == Goal::wrench && batch.found) {
    const unsigned long long at = atomicAdd(batch.found, 1ull);
    if (at < batch.capacity) batch.hits[at] = {query, setup.a.grid.ids[ia], setup.b.grid.ids[ib]};
  }
  return true;
}

/// Where a lane looks for partners.
struct LaneWalk {
  core::Lookup lookup;
  std::uint32_t cell, cells;  ///< the next one, and how many there are
  std::uint32_t at;           ///< the next sphere, of those that the present cell lists or of the whole grid
  std::uint32_t end;
  bool all;  ///< of the whole grid
};

/// Goes to the next cell.
inline __device__ void enter(const core::GridView& grid, const core::Cells& cells, LaneWalk& walk) {
  walk.all = cells.all;
  if (cells.all) {
    ++walk.cell;
    walk.at = 0;
    walk.end = grid.count;
    return;
  }
  std::uint32_t at[3] = {cells.box.lo[0], cells.box.lo[1], cells.box.lo[2]};
  if (cells.count > 1) cells.coordinates(walk.cell, at);
  ++walk.cell;
  const core::Cell cell = core::findCell(grid, core::cellKey(cells.tier, at[0], at[1], at[2]));
  walk.at = cell.first;
  walk.end = cell.first + cell.count;
}

inline __device__ void begin(const core::Walker& walker, const core::Cluster& cluster, unsigned lane,
                             LaneWalk& walk) {
  walk.cell = walk.cells = 0;
  walk.at = walk.end = 0;
  if (lane >= cluster.count) return;
  if (!core::makeLookup(walker, walker.own.spheres[cluster.first + lane], walk.lookup)) return;
  const core::Cells cells = core::cellsOf(walker.grid, walk.lookup);
  walk.cells = cells.count;
  if (cells.count != 0) enter(walker.grid, cells, walk);
}

/// The places of the next spheres.
inline __device__ uint4 nextPlaces(const core::GridView& grid, const LaneWalk& walk, std::uint32_t at) {
  if (!walk.all) return __ldg(reinterpret_cast<const uint4*>(grid.listed + at));
  return {min(at, grid.count), min(at + 1, grid.count), min(at + 2, grid.count), min(at + 3, grid.count)};
}

/// Tests the next up to kRun spheres. Returns a bit for each that the walker meets.
inline __device__ unsigned testRun(const core::GridView& grid, const LaneWalk& walk) {
  const auto* spheres = reinterpret_cast<const float4*>(grid.centred);
  const std::uint32_t end = min(walk.end, walk.at + kRun);
  unsigned met = 0, bit = 1;
  for (std::uint32_t at = walk.at; at < end; at += core::kListStep) {
    const uint4 places = nextPlaces(grid, walk, at);
    const float4 s[core::kListStep] = {__ldg(spheres + places.x), __ldg(spheres + places.y),
                                       __ldg(spheres + places.z), __ldg(spheres + places.w)};
#pragma unroll
    for (std::uint32_t i = 0; i < core::kListStep; ++i) {
      if (core::meets(walk.lookup, {s[i].x, s[i].y, s[i].z, s[i].w})) met |= bit << i;
    }
    bit <<= core::kListStep;
  }
  return met;
}

/// Of those, the ones that count in this cell and not in another.
inline __device__ unsigned countedHere(const core::GridView& grid, const LaneWalk& walk, unsigned met) {
  const core::Cells cells = core::cellsOf(grid, walk.lookup);
  std::uint32_t at[3];
  cells.coordinates(walk.cell - 1, at);
  unsigned counted = 0;
  for (unsigned left = met; left != 0; left &= left - 1) {
    const std::uint32_t place =
        grid.listed[walk.at + static_cast<unsigned>(__ffs(static_cast<int>(left)) - 1)];
    if (core::countsIn(grid, cells, at, grid.centred[place])) counted |= left & -left;
  }
  return counted;
}

/// Walks a job.
template <Goal goal>
__global__ void __launch_bounds__(kWarp, 24) walkBatch(const __grid_constant__ Batch batch) {
  __shared__ Scratch scratch;
  const unsigned lane = threadIdx.x;
  const Job job = findJob(batch);
  const core::Setup& setup = batch.setups[job.query];
  DeviceSums& total = batch.sums[job.query];
  if (goal == Goal::touch && *static_cast<volatile unsigned long long*>(&total.pairs) != 0) return;

  const std::uint32_t clusters = setup.a.clusters + setup.b.clusters;
  bool active = false;
  if (lane < batch.job_size && job.first + lane < clusters) {
    const std::uint32_t number = job.first + lane;
    const bool from_a = core::isFromA(setup, number);
    const core::Walker walker = core::walkerOf(setup, from_a);
    active = core::clusterMeets(walker, walker.own.clusters[from_a ? number : number - setup.a.clusters]);
  }

  WarpSums<kTermCount<goal>> sums;
  sums.clear();
  unsigned queued = 0, rounds = 0;
  unsigned left = __ballot_sync(kAll, active);
  if (left == 0) return;
  LaneWalk walk;
  walk.cell = walk.cells = 0;
  walk.at = walk.end = 0;
  std::uint32_t self = 0;
  bool from_a = true;
  while (true) {
    bool walks = walk.at < walk.end || walk.cell < walk.cells;
    if (!__any_sync(kAll, walks) && left != 0) {
      const std::uint32_t number = job.first + static_cast<std::uint32_t>(__ffs(static_cast<int>(left)) - 1);
      left &= left - 1;
      from_a = core::isFromA(setup, number);
      const core::Walker walker = core::walkerOf(setup, from_a);
      const core::Cluster cluster = walker.own.clusters[from_a ? number : number - setup.a.clusters];
      self = (cluster.first + lane) | (from_a ? kFromA : 0);
      begin(walker, cluster, lane, walk);
      walks = walk.at < walk.end || walk.cell < walk.cells;
    }
    const bool flush = !__any_sync(kAll, walks);
    const core::GridView& grid = from_a ? setup.b.grid : setup.a.grid;
    unsigned met = 0;
    const std::uint32_t* places = nullptr;
    std::uint32_t first = 0;
    if (walks) {
      if (walk.at == walk.end)
        enter(grid, core::cellsOf(grid, walk.lookup), walk);  // rare: kept in no register
      if (!walk.all) places = grid.listed;
      first = walk.at;
      met = testRun(grid, walk);
      if (walk.cells > 1 && met != 0) met = countedHere(grid, walk, met);
      walk.at = min(walk.at + kRun, walk.end);
    }
    while (true) {
      const unsigned finders = __ballot_sync(kAll, met != 0);
      if (met != 0) {
        const std::uint32_t at = first + static_cast<std::uint32_t>(__ffs(static_cast<int>(met)) - 1);
        met &= met - 1;
        scratch.queue[queued + __popc(finders & ((1u << lane) - 1))] = {self, places ? places[at] : at};
      }
      queued += __popc(finders);
      const bool drain = flush && queued > 0;
      if (queued >= kWarp || drain) {
        __syncwarp();
        const unsigned taken = min(queued, kWarp);
        queued -= taken;
        core::Terms terms{};
        const bool hit =
            lane < taken && decide<goal>(batch, setup, job.query, scratch.queue[queued + lane], terms);
        if (goal == Goal::touch && __any_sync(kAll, hit)) {
          if (lane == 0) atomicExch(&total.pairs, 1ull);
          return;
        }
        if (goal != Goal::touch) {
          sums.pairs += hit ? 1 : 0;
          addTerms(terms, setup.units, scratch, lane, sums);
        }
        __syncwarp();
        ++rounds;
      }
      if (finders == 0 && !(flush && queued > 0)) break;
    }
    if (goal != Goal::touch && rounds > kRoundsPerSum - 2 * kRun) {
      addWarp(total, setup.units, sums, lane);
      rounds = 0;
    }
    if (flush && left == 0) break;
  }
  if (goal != Goal::touch) addWarp(total, setup.units, sums, lane);
}

}  // namespace innersphere::device
