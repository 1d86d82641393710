// The spheres of a grid in their order, and their clusters.
#include <cub/device/device_scan.cuh>

#include "cuda_cells.hpp"

namespace innersphere::device {

namespace {

constexpr unsigned kThreads = 128;

__constant__ core::HilbertTable hilbert_table = core::kHilbertTable;

/// A thread takes a sphere: its key, and its number in its bucket. All clear the table.
__global__ void makeKeys(const __grid_constant__ BuildPlan plan, const __grid_constant__ GridArrays arrays,
                         const Sphere* given, std::uint64_t* keys, std::uint32_t* numbers,
                         std::uint32_t* counts) {
  __shared__ core::HilbertTable table;
  constexpr unsigned kWords = sizeof table / sizeof(unsigned);
  for (unsigned i = threadIdx.x; i < kWords; i += kThreads)
    reinterpret_cast<unsigned*>(&table)[i] = reinterpret_cast<const unsigned*>(&hilbert_table)[i];
  __syncthreads();
  const std::uint32_t i = blockIdx.x * kThreads + threadIdx.x;
  for (std::uint64_t at = i; at < arrays.table_room; at += gridDim.x * kThreads)
    arrays.cells[at] = {~std::uint64_t{0}, 0, 0};
  if (i >= plan.grid.view.count) return;
  const std::uint64_t key = plan.grid.keyOf(load(given + i), table);
  keys[i] = key;
  numbers[i] = atomicAdd(counts + (key >> plan.bucket_shift), 1u);
}

/// A thread takes a sphere to its bucket.
__global__ void fillBuckets(const __grid_constant__ BuildPlan plan, const std::uint64_t* keys,
                            const std::uint32_t* numbers, const std::uint32_t* starts,
                            std::uint64_t* bucket_keys, std::uint32_t* ids) {
  const std::uint32_t i = blockIdx.x * kThreads + threadIdx.x;
  if (i >= plan.grid.view.count) return;
  const std::uint64_t key = keys[i];
  const std::uint32_t at = starts[key >> plan.bucket_shift] + numbers[i];
  bucket_keys[at] = key;
  ids[at] = i;
}

/// A thread takes a sphere to its place in its bucket: by its key, then by its index.
__global__ void orderBuckets(const __grid_constant__ BuildPlan plan, const std::uint64_t* bucket_keys,
                             const std::uint32_t* ids, const std::uint32_t* starts, std::uint32_t* sorted) {
  const std::uint32_t at = blockIdx.x * kThreads + threadIdx.x;
  if (at >= plan.grid.view.count) return;
  const std::uint64_t key = bucket_keys[at];
  const std::uint32_t id = ids[at], bucket = static_cast<std::uint32_t>(key >> plan.bucket_shift);
  const std::uint32_t first = starts[bucket], end = starts[bucket + 1];
  std::uint32_t place = first;
  for (std::uint32_t other = first; other < end; ++other) {
    const std::uint64_t other_key = bucket_keys[other];
    const bool before = other_key == key ? ids[other] < id : other_key < key;
    place += before ? 1 : 0;
  }
  sorted[place] = id;
}

/// A ball about the middle of the centres of some spheres, around all of them: a lane has one each, which is
/// not `valid` in those beyond.
__device__ Sphere ballAround(const Sphere& s, bool valid) {
  constexpr float kMax = 3.402823466e+38f;
  const auto upper = [&](float x) { return maximum(valid ? x : -kMax); };
  const core::Vec3f lo{-upper(-s.x), -upper(-s.y), -upper(-s.z)}, hi{upper(s.x), upper(s.y), upper(s.z)};
  const core::Vec3f middle = core::middleOf(lo, hi);
  const core::Vec3r d = core::Vec3r{s.x, s.y, s.z} - core::Vec3r{middle.x, middle.y, middle.z};
  const double radius = maximum(valid ? sqrt(dot(d, d)) + s.radius : 0.0);
  return {middle.x, middle.y, middle.z, nextafterf(static_cast<float>(radius), INFINITY)};
}

/// A warp takes a cluster. `counts`, of cells, may be null.
__global__ void orderSpheres(const __grid_constant__ BuildPlan plan,
                             const __grid_constant__ GridArrays arrays, const Sphere* given,
                             const std::uint32_t* sorted, std::uint32_t* counts) {
  __shared__ core::CellsNear shared[kThreads / kWarp][kWarp];
  const unsigned lane = threadIdx.x % kWarp, number = (blockIdx.x * kThreads + threadIdx.x) / kWarp;
  ClusterJob job;
  if (!clusterJob(plan, number, job)) return;
  const bool valid = lane < job.count;
  const std::uint32_t place = job.first + lane, id = valid ? sorted[place] : 0;
  const Sphere s = valid ? load(given + id) : Sphere{};
  if (job.part == 0 && job.tier == 0) {
    if (valid) {
      arrays.spheres[place] = s;
      arrays.ids[place] = id;
      arrays.places[id] = place;
    }
    const Sphere ball = ballAround(s, valid);
    if (lane == 0) arrays.clusters[job.cluster] = {ball, job.first, job.count};
  }
  if (!counts) return;
  std::uint32_t* const of_tier = counts + plan.tiers.first[job.tier];
  forCells<std::uint32_t>(plan.tiers, job, plan.grid.centred(s), lane, shared[threadIdx.x / kWarp],
                          [&](const std::uint32_t(&cells)[kTogether], unsigned mask, std::uint32_t) {
#pragma unroll
                            for (unsigned k = 0; k < kTogether; ++k) {
                              if ((mask >> k & 1) != 0) atomicAdd(of_tier + cells[k], 1u);
                            }
                          });
}

unsigned blocksFor(std::uint64_t threads) {
  return static_cast<unsigned>((threads + kThreads - 1) / kThreads);
}

}  // namespace

void launchOrder(const BuildPlan& plan, const GridArrays& arrays, bool count, BuildScratch& scratch,
                 cudaStream_t stream) {
  const std::uint32_t spheres = plan.grid.view.count;
  const std::uint64_t cells = count ? plan.tiers.first[plan.tiers.count] + 1 : 0;
  const std::uint64_t counters = plan.buckets + 1 + cells + 1;  // the last is for the longest list
  for (auto& keys : scratch.keys) keys.reserve(spheres);
  for (auto& numbers : scratch.numbers) numbers.reserve(spheres);
  scratch.counts.reserve(counters);
  scratch.starts.reserve(plan.buckets + 1);
  std::uint32_t *const counts = scratch.counts.data(), *const starts = scratch.starts.data();
  std::uint64_t *const keys = scratch.keys[0].data(), *const bucket_keys = scratch.keys[1].data();
  std::uint32_t *const numbers = scratch.numbers[0].data(), *const ids = scratch.numbers[1].data();
  INNERSPHERE_CUDA(cudaMemsetAsync(counts, 0, counters * sizeof(std::uint32_t), stream));
  makeKeys<<<blocksFor(spheres), kThreads, 0, stream>>>(plan, arrays, scratch.given.data(), keys, numbers,
                                                        counts);
  withScratch(scratch.cub, [&](void* p, std::size_t& size) {
    return cub::DeviceScan::ExclusiveSum(p, size, counts, starts, static_cast<int>(plan.buckets + 1), stream);
  });
  fillBuckets<<<blocksFor(spheres), kThreads, 0, stream>>>(plan, keys, numbers, starts, bucket_keys, ids);
  orderBuckets<<<blocksFor(spheres), kThreads, 0, stream>>>(plan, bucket_keys, ids, starts, numbers);
  const std::uint64_t jobs = plan.jobs.all;
  orderSpheres<<<blocksFor(kWarp * jobs), kThreads, 0, stream>>>(plan, arrays, scratch.given.data(), numbers,
                                                                 count ? counts + plan.buckets + 1 : nullptr);
  INNERSPHERE_CUDA(cudaGetLastError());
}

}  // namespace innersphere::device
