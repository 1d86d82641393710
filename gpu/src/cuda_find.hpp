// Finds candidates: a warp takes some clusters of one query, one after the other, a lane for each sphere.
#pragma once

#include "core/walk.hpp"
#include "cuda_batch.hpp"

namespace innersphere::device {

constexpr unsigned kFindWarps = 1;  ///< in a block; more would have nothing to do with each other

/// What a warp works on.
struct Job {
  unsigned query;
  std::uint32_t first;  ///< cluster, of all of A's and then all of B's
};

/// Of the job number `number` of a launch; its warps may be more than the jobs.
inline __device__ Job findJob(const Batch& batch, unsigned number) {
  if (!batch.setups) return {0, number * batch.job_size};
  // Often all queries have as many jobs, and this is the one.
  const unsigned long long job = batch.first_job + number;
  unsigned lo = static_cast<unsigned>(static_cast<unsigned long long>(number) * batch.count / batch.jobs);
  if (job < batch.first[lo] || job >= batch.first[lo + 1]) {
    lo = 0;
    for (unsigned hi = batch.count; hi - lo > 1;) {
      const unsigned middle = lo + (hi - lo) / 2;
      (batch.first[middle] <= job ? lo : hi) = middle;
    }
  }
  return {lo, static_cast<std::uint32_t>(job - batch.first[lo]) * batch.job_size};
}

/// The sum over this lane and all before it.
inline __device__ unsigned scan(unsigned x, unsigned lane) {
  for (unsigned step = 1; step < kWarp; step *= 2) {
    const unsigned before = __shfl_up_sync(kAll, x, step);
    if (lane >= step) x += before;
  }
  return x;
}

/// The first lane whose scanned number is above x, or the last one.
inline __device__ unsigned laneOf(unsigned scanned, unsigned x) {
  unsigned lane = 0;
#pragma unroll
  for (unsigned step = kWarp / 2; step > 0; step /= 2) {
    if (__shfl_sync(kAll, scanned, lane + step - 1) <= x) lane += step;
  }
  return lane;
}

/// A sphere of the cluster, as all lanes read it.
struct SharedWalk {
  float4 ball;            ///< centre and reach
  float smallest;         ///< see core::Lookup
  std::uint32_t first;    ///< of its spheres: less kListStep times the steps of the lanes before
  std::uint32_t cell;     ///< the number of the cell, where it looks into several
  std::uint32_t several;  ///< 0: no; 1: yes; 2: the spheres are those of the whole grid
};

/// The spheres that a cluster's spheres are tested against: a run for each, cut into steps of kListStep, that
/// are dealt out to the lanes, so that all of them have work however long the runs are.
struct Steps {
  unsigned scanned;  ///< steps of this lane's run and of all before
  unsigned total;
};

/// Looks up the cell number `number` of each lane that has so many.
inline __device__ Steps lookUp(const core::GridView& grid, const core::Lookup& lookup,
                               const core::Cells& cells, std::uint32_t number, unsigned lane,
                               SharedWalk& shared) {
  std::uint32_t first = 0, count = 0;
  shared.several = 0;
  if (number < cells.count) {
    if (cells.all) {
      count = grid.count;
      shared.several = 2;
    } else {
      std::uint32_t at[3] = {cells.box.lo[0], cells.box.lo[1], cells.box.lo[2]};
      if (cells.count > 1) {
        cells.coordinates(number, at);
        shared.several = 1;
      }
      const core::Cell cell = core::findCell(grid, core::cellKey(cells.tier, at[0], at[1], at[2]));
      first = cell.first;
      count = cell.count;
    }
  }
  const unsigned steps = (count + core::kListStep - 1) / core::kListStep;
  const unsigned scanned = scan(steps, lane);
  shared.ball = {lookup.p.x, lookup.p.y, lookup.p.z, lookup.reach};
  shared.smallest = lookup.smallest;
  shared.first = first - (scanned - steps) * core::kListStep;
  shared.cell = number;
  return {scanned, __shfl_sync(kAll, scanned, kWarp - 1)};
}

/// Of a walker that looks into several cells: whether a partner counts in this one.
inline __device__ bool countsHere(const core::GridView& grid, const SharedWalk& walk, std::uint32_t place) {
  const core::Lookup lookup{{walk.ball.x, walk.ball.y, walk.ball.z}, walk.ball.w, walk.smallest};
  const core::Cells cells = core::cellsOf(grid, lookup);
  std::uint32_t at[3];
  cells.coordinates(walk.cell, at);
  return core::countsIn(grid, cells, at, grid.centred[place]);
}

/// The places of the spheres of one step.
inline __device__ uint4 placesOf(const core::GridView& grid, const SharedWalk& walk, unsigned step) {
  const std::uint32_t at = walk.first + step * core::kListStep;
  if (walk.several != 2) return __ldg(reinterpret_cast<const uint4*>(grid.listed + at));
  // Past the end there is the sphere that meets nothing.
  return {min(at, grid.count), min(at + 1, grid.count), min(at + 2, grid.count), min(at + 3, grid.count)};
}

inline __device__ std::uint32_t placeOf(const uint4& places, unsigned k) {
  return k == 0 ? places.x : k == 1 ? places.y : k == 2 ? places.z : places.w;
}

/// A bit for each of them that the walker meets.
inline __device__ unsigned testStep(const core::GridView& grid, const SharedWalk& walk, const uint4& places) {
  const core::Lookup lookup{{walk.ball.x, walk.ball.y, walk.ball.z}, walk.ball.w, walk.smallest};
  const Sphere spheres[core::kListStep] = {load(grid.centred + places.x), load(grid.centred + places.y),
                                           load(grid.centred + places.z), load(grid.centred + places.w)};
  unsigned met = 0;
#pragma unroll
  for (unsigned k = 0; k < core::kListStep; ++k) {
    if (core::meets(lookup, spheres[k])) met |= 1u << k;
  }
  if (walk.several == 1) {
    for (unsigned left = met; left != 0; left &= left - 1) {
      const auto k = static_cast<unsigned>(__ffs(static_cast<int>(left)) - 1);
      if (!countsHere(grid, walk, placeOf(places, k))) met &= ~(1u << k);
    }
  }
  return met;
}

/// Where a warp puts its candidates. They are written for a kernel that decides them side by side, with no
/// walk in its registers.
class ChunkWriter {
 public:
  __device__ ChunkWriter(const Batch& batch, unsigned query, unsigned lane)
      : batch_(batch), query_(query), lane_(lane) {}

  /// All lanes call it together; those of `finders` have one.
  __device__ void add(unsigned finders, std::uint32_t walker, std::uint32_t partner) {
    const unsigned count = __popc(finders);
    if (filled_ + count > batch_.chunk_size || chunk_ == kNone) {
      close();
      unsigned long long taken = 0;
      if (lane_ == 0) taken = atomicAdd(batch_.taken, 1ull);
      chunk_ = __shfl_sync(kAll, taken, 0);
      filled_ = 0;
    }
    if ((finders >> lane_ & 1) != 0 && chunk_ < batch_.chunk_capacity) {
      const unsigned at = filled_ + __popc(finders & ((1u << lane_) - 1));
      batch_.candidates[chunk_ * batch_.chunk_size + at] = {walker, partner};
    }
    filled_ += count;
  }

  __device__ void close() {
    if (lane_ == 0 && chunk_ < batch_.chunk_capacity) batch_.chunks[chunk_] = {query_, filled_};
  }

 private:
  static constexpr unsigned long long kNone = ~0ull;
  const Batch& batch_;
  unsigned query_, lane_;
  unsigned long long chunk_ = kNone;
  unsigned filled_ = 0;
};

/// Walks a job. With kTouch it stops at the first pair of its query, and writes nothing but that.
template <bool kTouch>
__global__ void __launch_bounds__(kFindWarps* kWarp, 32 / kFindWarps)
    findCandidates(const __grid_constant__ Batch batch) {
  __shared__ SharedWalk all_shared[kFindWarps][kWarp];
  const unsigned lane = threadIdx.x % kWarp, warp = threadIdx.x / kWarp;
  SharedWalk(&shared)[kWarp] = all_shared[warp];
  const unsigned job_number = blockIdx.x * kFindWarps + warp;
  if (job_number >= batch.jobs) return;
  const Job job = findJob(batch, job_number);
  const core::Setup& setup = batch.setup(job.query);
  unsigned long long& pairs = batch.sums[job.query].pairs;
  if (kTouch && *static_cast<volatile unsigned long long*>(&pairs) != 0) return;

  const std::uint32_t clusters = setup.a.clusters + setup.b.clusters;
  bool active = false;
  if (lane < batch.job_size && job.first + lane < clusters) {
    const std::uint32_t number = job.first + lane;
    const bool from_a = core::isFromA(setup, number);
    const core::Walker walker = core::walkerOf(setup, from_a);
    active = core::clusterMeets(walker, walker.own.clusters[from_a ? number : number - setup.a.clusters]);
  }
  ChunkWriter writer(batch, job.query, lane);
  for (unsigned left = __ballot_sync(kAll, active); left != 0; left &= left - 1) {
    const std::uint32_t number = job.first + static_cast<std::uint32_t>(__ffs(static_cast<int>(left)) - 1);
    const bool from_a = core::isFromA(setup, number);
    const core::Walker walker = core::walkerOf(setup, from_a);
    const core::Cluster cluster = walker.own.clusters[from_a ? number : number - setup.a.clusters];
    const core::GridView& grid = walker.grid;
    core::Lookup lookup{};
    core::Cells cells{};
    if (lane < cluster.count &&
        core::makeLookup(walker, load(walker.own.spheres + cluster.first + lane), lookup))
      cells = core::cellsOf(grid, lookup);
    for (std::uint32_t cell = 0; __any_sync(kAll, cell < cells.count); ++cell) {
      if (cell > 0) cells = core::cellsOf(grid, lookup);  // rare: found anew, not kept in registers
      __syncwarp();
      const Steps steps = lookUp(grid, lookup, cells, cell, lane, shared[lane]);
      __syncwarp();
      const std::uint32_t none = grid.count;
      unsigned owner = 0;
      uint4 places{};
      const auto fetch = [&](unsigned step) {  // one round ahead of the test, to hide how long it takes
        owner = laneOf(steps.scanned, step);
        places = step < steps.total ? placesOf(grid, shared[owner], step) : uint4{none, none, none, none};
      };
      fetch(lane);
      for (unsigned begin = 0; begin < steps.total; begin += kWarp) {
        const std::uint32_t self = (cluster.first + owner) | (from_a ? kFromA : 0);
        const uint4 tested = places;
        unsigned met = testStep(grid, shared[owner], tested);
        fetch(begin + kWarp + lane);
        while (true) {
          const unsigned finders = __ballot_sync(kAll, met != 0);
          if (finders == 0) break;
          const std::uint32_t partner =
              met != 0 ? placeOf(tested, static_cast<unsigned>(__ffs(static_cast<int>(met)) - 1)) : 0;
          if constexpr (kTouch) {
            const DevicePair pair = pairOf(self, partner);
            if (__any_sync(kAll, met != 0 && core::isHit(makePair(setup, pair), pair.from_a))) {
              if (lane == 0) atomicExch(&pairs, 1ull);
              return;
            }
          } else {
            writer.add(finders, self, partner);
          }
          met &= met - 1;
        }
      }
    }
  }
  if constexpr (!kTouch) writer.close();
}

}  // namespace innersphere::device
