// The walk as the device runs it. A warp takes some clusters of one query, one after the other, a lane for
// each sphere.
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
constexpr unsigned kMostParts = 8;           ///< jobs that share a cluster where there are few clusters
constexpr unsigned kPartners = 128;          ///< spheres near a cluster that are kept before they are tested
constexpr unsigned kUnroll = 8;              ///< partners that are tested at once
constexpr unsigned kQueue = 2 * kWarp;       ///< candidates
static_assert(kPartners + 2 <= (3u << (core::kShortSumBits - 7)),
              "partners that are tested add so many rounds");
constexpr unsigned kRoundsPerSum = 1u << (core::kShortSumBits - 5);  ///< each of which adds a warp's terms
constexpr std::uint32_t kFromA = 1u << 31;                           ///< of a candidate's walker

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
  unsigned parts;     ///< jobs that share a cluster
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
  unsigned part;        ///< of the lookups of each cluster
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
  const auto number = static_cast<std::uint32_t>(blockIdx.x - batch.first[lo]);
  return {lo, number / batch.parts * batch.job_size, number % batch.parts};
}

/// The sum over this lane and all before it.
inline __device__ unsigned scan(unsigned x, unsigned lane) {
  for (unsigned step = 1; step < kWarp; step *= 2) {
    const unsigned before = __shfl_up_sync(kAll, x, step);
    if (lane >= step) x += before;
  }
  return x;
}

/// The first lane whose scanned number is above x.
inline __device__ unsigned laneOf(unsigned scanned, unsigned x) {
  unsigned lane = 0;
  for (unsigned step = kWarp / 2; step > 0; step /= 2) {
    if (__shfl_sync(kAll, scanned, lane + step - 1) <= x) lane += step;
  }
  return lane;
}

inline __device__ unsigned warpOr(unsigned x) {
#if __CUDA_ARCH__ >= 800
  return __reduce_or_sync(kAll, x);
#else
  for (unsigned step = kWarp / 2; step > 0; step /= 2) x |= __shfl_xor_sync(kAll, x, step);
  return x;
#endif
}

inline __device__ float warpMin(float x) {
  for (unsigned step = kWarp / 2; step > 0; step /= 2) x = fminf(x, __shfl_xor_sync(kAll, x, step));
  return x;
}
inline __device__ float warpMax(float x) {
  return -warpMin(-x);
}

inline __device__ float squaredLength(float x, float y, float z) {
  return __fmaf_rn(x, x, __fmaf_rn(y, y, z * z));
}

constexpr int kPass = 4;                          ///< terms that the lanes exchange at once
constexpr unsigned kShare = kWarp / (2 * kPass);  ///< lanes that sum one column

/// Memory of one warp.
struct Scratch {
  float4 partners[kPartners];  ///< spheres near the cluster, relative to the centre of the grid
  std::uint32_t places[kPartners];
  std::uint32_t runs[kWarp];  ///< for those that hold something: place of the first, less spheres before it
  uint2 queue[kQueue];        ///< candidates: places of walker and partner
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

/// A cluster, seen from the other grid: a lane for each sphere.
struct LaneWalker {
  core::Vec3f p;
  float reach;          ///< radius with all margins and tolerances
  core::Vec3f lo, hi;   ///< around the centres of all lanes
  float largest_reach;  ///< of all lanes
};

/// False if none of its spheres can meet one of the grid.
inline __device__ bool makeWalker(const core::Walker& walker, const core::Cluster& cluster, unsigned lane,
                                  LaneWalker& own) {
  const float infinity = __int_as_float(0x7f800000);
  own.p = {infinity, infinity, infinity};
  own.reach = 0;
  bool meets = false;
  if (lane < cluster.count) {
    const core::Probe probe = core::makeProbe(walker.search, walker.own.spheres[cluster.first + lane]);
    const float reach = probe.radius + walker.search.grid_margin + walker.search.tolerance;
    meets = core::meetsBounds(walker.grid, probe.p, reach);
    if (meets) {
      own.p = probe.p;
      own.reach = reach;
    }
  }
  if (!__any_sync(kAll, meets)) return false;
  own.lo = {warpMin(own.p.x), warpMin(own.p.y), warpMin(own.p.z)};
  own.hi = {warpMax(meets ? own.p.x : -infinity), warpMax(meets ? own.p.y : -infinity),
            warpMax(meets ? own.p.z : -infinity)};
  own.largest_reach = warpMax(own.reach);
  return true;
}

/// A run of spheres.
struct Run {
  std::uint32_t first, count;
};

/// The blocks near a cluster on all levels, numbered through. Lane l knows those of level l.
struct Lookups {
  core::CellBox box;
  unsigned scanned;  ///< blocks of this level and all finer ones
  bool whole;        ///< this level counts as one block
  unsigned total;
};
static_assert(core::kAxisBits + 2 <= static_cast<int>(kWarp), "a lane for each level");

inline __device__ Lookups makeLookups(const core::Walker& walker, const core::Cluster& cluster,
                                      const LaneWalker& own, unsigned lane) {
  const core::GridView& grid = walker.grid;
  const float r = own.largest_reach;
  const core::Vec3f lo = own.lo - core::Vec3f{r, r, r}, hi = own.hi + core::Vec3f{r, r, r};
  Lookups lookups{};
  unsigned count = 0;
  const int l = static_cast<int>(lane);
  if (l >= core::firstLevel(walker, cluster) && l < grid.level_count) {
    const core::Level level = grid.levels[l];
    if (level.count != 0 && core::blockBox(grid, level, walker.search, lo, hi, lookups.box)) {
      std::uint64_t blocks = 1;
      for (int axis = 0; axis < 3; ++axis) blocks *= lookups.box.hi[axis] - lookups.box.lo[axis] + 1;
      lookups.whole = blocks >= level.blocks;
      count = lookups.whole ? 1 : static_cast<unsigned>(blocks);
    }
  }
  lookups.scanned = scan(count, lane);
  lookups.total = __shfl_sync(kAll, lookups.scanned, kWarp - 1);
  return lookups;
}

/// The run of the block number `number`. All lanes call it together.
inline __device__ Run lookUp(const core::GridView& grid, const Lookups& lookups, unsigned number) {
  const unsigned level = laneOf(lookups.scanned, number);
  const unsigned x0 = __shfl_sync(kAll, lookups.box.lo[0], level),
                 x1 = __shfl_sync(kAll, lookups.box.hi[0], level);
  const unsigned y0 = __shfl_sync(kAll, lookups.box.lo[1], level),
                 y1 = __shfl_sync(kAll, lookups.box.hi[1], level);
  const unsigned z0 = __shfl_sync(kAll, lookups.box.lo[2], level);
  const bool whole = __shfl_sync(kAll, lookups.whole, level);
  const unsigned finer = __shfl_sync(kAll, lookups.scanned, level > 0 ? level - 1 : 0);
  const unsigned start = level > 0 ? finer : 0;
  if (number >= lookups.total) return {0, 0};
  if (whole) return {grid.levels[level].first, grid.levels[level].count};
  const unsigned at = number - start, nx = x1 - x0 + 1, ny = y1 - y0 + 1;
  const unsigned row = at / nx;
  const core::Block block = core::findBlock(
      grid, core::blockKey(static_cast<int>(level), x0 + at % nx, y0 + row % ny, z0 + row / ny));
  return {block.first, block.count};
}

/// Walks a job. The lanes find candidates at different times; they are queued, and decided side by side.
template <Goal goal>
__global__ void __launch_bounds__(kWarp, 16) walkBatch(const __grid_constant__ Batch batch) {
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
  for (unsigned left = __ballot_sync(kAll, active); left != 0; left &= left - 1) {
    const bool last_cluster = (left & (left - 1)) == 0;
    const std::uint32_t number = job.first + static_cast<std::uint32_t>(__ffs(static_cast<int>(left)) - 1);
    const bool from_a = core::isFromA(setup, number);
    const core::Walker walker = core::walkerOf(setup, from_a);
    const core::Cluster cluster = walker.own.clusters[from_a ? number : number - setup.a.clusters];
    const std::uint32_t self = (cluster.first + lane) | (from_a ? kFromA : 0);
    const core::Vec3f centre = walker.grid.centre;
    LaneWalker own;
    Lookups lookups{};
    if (makeWalker(walker, cluster, lane, own)) lookups = makeLookups(walker, cluster, own, lane);

    const unsigned end = lookups.total * (job.part + 1) / batch.parts;
    unsigned partners = 0;
    for (unsigned begin = lookups.total * job.part / batch.parts;; begin += kWarp) {
      Run run{0, 0};
      if (begin < end) {
        run = lookUp(walker.grid, lookups, begin + lane);
        if (begin + lane >= end) run.count = 0;
      }
      const unsigned scanned = scan(run.count, lane);
      const unsigned spheres = __shfl_sync(kAll, scanned, kWarp - 1);
      const bool last_blocks = begin + kWarp >= end;
      const unsigned start = scanned - run.count;
      const unsigned filled = __ballot_sync(kAll, run.count != 0);
      __syncwarp();
      if (run.count != 0) scratch.runs[__popc(filled & ((1u << lane) - 1))] = run.first - start;
      __syncwarp();
      unsigned runs = 0;  // that begin before s
      for (unsigned s = 0;; s += kWarp) {
        if (s < spheres) {  // keep what is near the cluster's box
          const bool begins = run.count != 0 && start >= s && start < s + kWarp;
          const unsigned heads = warpOr(begins ? 1u << (start - s) : 0);
          const unsigned number = runs + __popc(heads & (kAll >> (kWarp - 1 - lane))) - 1;
          runs += __popc(heads);
          const unsigned place = scratch.runs[number] + s + lane;
          bool near = s + lane < spheres;
          float4 partner{};
          if (near) {
            const Sphere sphere = walker.grid.spheres[place];
            partner = {sphere.x - centre.x, sphere.y - centre.y, sphere.z - centre.z, sphere.radius};
            const float dx = fmaxf(fmaxf(own.lo.x - partner.x, partner.x - own.hi.x), 0.0f);
            const float dy = fmaxf(fmaxf(own.lo.y - partner.y, partner.y - own.hi.y), 0.0f);
            const float dz = fmaxf(fmaxf(own.lo.z - partner.z, partner.z - own.hi.z), 0.0f);
            const float sum = partner.w + own.largest_reach;
            near = !(squaredLength(dx, dy, dz) > sum * sum);
          }
          const unsigned all_near = __ballot_sync(kAll, near);
          if (near) {
            const unsigned at = partners + __popc(all_near & ((1u << lane) - 1));
            scratch.partners[at] = partner;
            scratch.places[at] = place;
          }
          partners += __popc(all_near);
        }
        const bool last_spheres = s + kWarp >= spheres;
        const bool cluster_done = last_blocks && last_spheres;
        const bool flush = cluster_done && last_cluster;
        if (partners + kWarp > kPartners || cluster_done) {
          __syncwarp();
          unsigned at = 0;
          do {
            const unsigned count = min(kWarp, partners - at);
            unsigned near = 0;
            for (unsigned k = 0; k < count; k += kUnroll) {
              unsigned some = 0;
#pragma unroll
              for (unsigned i = 0; i < kUnroll; ++i) {  // past the end is what was there before
                const float4 partner = scratch.partners[at + k + i];
                const float sum = partner.w + own.reach;
                const float gap2 =
                    squaredLength(partner.x - own.p.x, partner.y - own.p.y, partner.z - own.p.z);
                if (!(gap2 > sum * sum)) some |= 1u << i;
              }
              near |= some << k;
            }
            if (count < kWarp) near &= (1u << count) - 1;
            while (true) {
              const unsigned finders = __ballot_sync(kAll, near != 0);
              if (near != 0) {
                const unsigned k = static_cast<unsigned>(__ffs(static_cast<int>(near)) - 1);
                near &= near - 1;
                scratch.queue[queued + __popc(finders & ((1u << lane) - 1))] = {self, scratch.places[at + k]};
              }
              queued += __popc(finders);
              const bool drain = flush && finders == 0 && at + kWarp >= partners && queued > 0;
              if (queued >= kWarp || drain) {
                __syncwarp();
                const unsigned taken = min(queued, kWarp);
                queued -= taken;
                core::Terms terms{};
                const bool hit = lane < taken &&
                                 decide<goal>(batch, setup, job.query, scratch.queue[queued + lane], terms);
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
              if (finders == 0 && !(drain && queued > 0)) break;
            }
            at += kWarp;
          } while (at < partners);
          partners = 0;
          if (goal != Goal::touch && rounds > kRoundsPerSum / 4) {
            addWarp(total, setup.units, sums, lane);
            rounds = 0;
          }
          __syncwarp();
        }
        if (last_spheres) break;
      }
      if (last_blocks) break;
    }
  }
  if (goal != Goal::touch) addWarp(total, setup.units, sums, lane);
}

}  // namespace innersphere::device
