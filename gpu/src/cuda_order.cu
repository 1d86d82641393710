// The spheres of a grid in their order, and their clusters.
#include <cub/device/device_radix_sort.cuh>

#include "cuda_cells.hpp"

namespace innersphere::device {

namespace {

constexpr unsigned kThreads = 128;

__constant__ core::HilbertTable hilbert_table = core::kHilbertTable;

template <typename Key>
__global__ void makeKeys(const __grid_constant__ core::GridPlan plan, const Sphere* given, Key* keys,
                         std::uint32_t* numbers) {
  __shared__ core::HilbertTable table;
  constexpr unsigned kWords = sizeof table / sizeof(unsigned);
  for (unsigned i = threadIdx.x; i < kWords; i += kThreads)
    reinterpret_cast<unsigned*>(&table)[i] = reinterpret_cast<const unsigned*>(&hilbert_table)[i];
  __syncthreads();
  const std::uint32_t i = blockIdx.x * kThreads + threadIdx.x;
  if (i >= plan.view.count) return;
  keys[i] = static_cast<Key>(plan.keyOf(load(given + i), table));
  numbers[i] = i;
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
  if (job.part == 0) {
    if (valid) {
      arrays.spheres[place] = s;
      arrays.ids[place] = id;
      arrays.places[id] = place;
    }
    const Sphere ball = ballAround(s, valid);
    if (lane == 0) arrays.clusters[job.cluster] = {ball, job.first, job.count};
  }
  if (!counts) return;
  forCells(plan.tiers, job, plan.grid.centred(s), lane, shared[threadIdx.x / kWarp],
           [&](const core::TierCells& tier, std::uint64_t first, std::uint32_t x, std::uint32_t y,
               std::uint32_t z, std::uint32_t) { atomicAdd(counts + first + tier.cellAt(x, y, z), 1u); });
}

unsigned blocksFor(std::uint64_t threads) {
  return static_cast<unsigned>((threads + kThreads - 1) / kThreads);
}

template <typename Key>
void sortSpheres(const core::GridPlan& plan, BuildScratch& scratch, cudaStream_t stream) {
  const std::uint32_t count = plan.view.count;
  for (auto& keys : scratch.keys) keys.reserve(count);
  for (auto& numbers : scratch.numbers) numbers.reserve(count);
  auto *keys = reinterpret_cast<Key*>(scratch.keys[0].data()),
       *sorted_keys = reinterpret_cast<Key*>(scratch.keys[1].data());
  makeKeys<<<blocksFor(count), kThreads, 0, stream>>>(plan, scratch.given.data(), keys,
                                                      scratch.numbers[0].data());
  INNERSPHERE_CUDA(cudaGetLastError());
  withScratch(scratch.cub, [&](void* p, std::size_t& size) {  // stable: equal keys keep the packing's order
    return cub::DeviceRadixSort::SortPairs(p, size, keys, sorted_keys, scratch.numbers[0].data(),
                                           scratch.numbers[1].data(), static_cast<int>(count), 0,
                                           plan.keyBits(), stream);
  });
}

}  // namespace

void launchOrder(const BuildPlan& plan, const GridArrays& arrays, bool count, BuildScratch& scratch,
                 cudaStream_t stream) {
  if (count) {
    const std::uint64_t cells = plan.tiers.first[plan.tiers.count];
    scratch.counts.reserve(cells + 1);
    INNERSPHERE_CUDA(cudaMemsetAsync(scratch.counts.data(), 0, (cells + 1) * sizeof(std::uint32_t), stream));
  }
  if (plan.grid.keyBits() <= 32) {
    sortSpheres<std::uint32_t>(plan.grid, scratch, stream);
  } else {
    sortSpheres<std::uint64_t>(plan.grid, scratch, stream);
  }
  const std::uint64_t jobs = plan.jobs.first[plan.grid.levels];
  orderSpheres<<<blocksFor(kWarp * jobs), kThreads, 0, stream>>>(
      plan, arrays, scratch.given.data(), scratch.numbers[1].data(), count ? scratch.counts.data() : nullptr);
  INNERSPHERE_CUDA(cudaGetLastError());
}

}  // namespace innersphere::device
