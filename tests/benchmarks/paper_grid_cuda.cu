#include <cuda_runtime.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <string>

#include "paper_grid_cuda.hpp"

namespace innersphere::benchmarks {
namespace {

void check(cudaError_t status) {
  if (status != cudaSuccess) throw std::runtime_error(std::string("CUDA: ") + cudaGetErrorString(status));
}

template <typename T>
class OnDevice {
 public:
  explicit OnDevice(std::size_t count) { check(cudaMalloc(&data_, count * sizeof(T))); }
  explicit OnDevice(const std::vector<T>& from) : OnDevice(from.size()) {
    check(cudaMemcpy(data_, from.data(), from.size() * sizeof(T), cudaMemcpyDefault));
  }
  ~OnDevice() { cudaFree(data_); }
  OnDevice(const OnDevice&) = delete;
  OnDevice& operator=(const OnDevice&) = delete;
  T* get() const { return data_; }

 private:
  T* data_ = nullptr;
};

struct Transform {
  float m[9], t[3];
};

struct Pose {
  Transform a_in_b, b_in_a;
};

struct Sum {
  double volume;
  unsigned long long pairs;
};

struct View {
  float lo[3], hi[3];  // of the box around all spheres
  const Sphere* spheres;
  const PaperGrid::Bucket* buckets;
  unsigned count, mask;
  int finest, coarsest;
};

Transform toTransform(const Placement& placement) {
  Transform to;
  for (std::size_t i = 0; i < 9; ++i) to.m[i] = static_cast<float>(placement.rotation[i]);
  for (std::size_t i = 0; i < 3; ++i) to.t[i] = static_cast<float>(placement.translation[i]);
  return to;
}

__device__ int exponentOf(float radius) {
  int e;
  const float fraction = frexpf(2 * radius, &e);
  return fraction == 0.5f ? e - 1 : e;
}

__device__ void traverse(const View& own, const View& grid, const Transform& to, bool strictly, unsigned i,
                         float& volume, unsigned& pairs) {
  const Sphere w = own.spheres[i];
  const float p[3] = {to.m[0] * w.x + to.m[1] * w.y + to.m[2] * w.z + to.t[0],
                      to.m[3] * w.x + to.m[4] * w.y + to.m[5] * w.z + to.t[1],
                      to.m[6] * w.x + to.m[7] * w.y + to.m[8] * w.z + to.t[2]};
  for (int axis = 0; axis < 3; ++axis) {  // the paper's broad phase
    if (p[axis] + w.radius < grid.lo[axis] || p[axis] - w.radius > grid.hi[axis]) return;
  }
  for (int level = max(exponentOf(w.radius), grid.finest); level <= grid.coarsest; ++level) {
    const float inverse = ldexpf(1.0f, -level);
    int lo[3], hi[3];
    for (int k = 0; k < 3; ++k) {
      lo[k] = static_cast<int>(floorf((p[k] - w.radius) * inverse));
      hi[k] = static_cast<int>(floorf((p[k] + w.radius) * inverse));
    }
    for (int x = lo[0]; x <= hi[0]; ++x) {
      for (int y = lo[1]; y <= hi[1]; ++y) {
        for (int z = lo[2]; z <= hi[2]; ++z) {
          unsigned hash = 5381;  // DJB2
          hash = hash * 33 + static_cast<unsigned>(level);
          hash = hash * 33 + static_cast<unsigned>(x);
          hash = hash * 33 + static_cast<unsigned>(y);
          hash = hash * 33 + static_cast<unsigned>(z);
          const PaperGrid::Bucket& found = grid.buckets[hash & grid.mask];
          for (unsigned k = 0; k < found.count; ++k) {
            const Sphere s = grid.spheres[found.spheres[k]];
            if (strictly ? !(s.radius > w.radius) : !(s.radius >= w.radius)) continue;
            const float dx = p[0] - s.x, dy = p[1] - s.y, dz = p[2] - s.z;
            const float d2 = dx * dx + dy * dy + dz * dz, sum = s.radius + w.radius;
            if (!(d2 < sum * sum) || exponentOf(s.radius) != level) continue;
            const float c[3] = {s.x, s.y, s.z};
            const int cell[3] = {x, y, z};
            bool counts = true;  // in the first cell that both are in
            for (int axis = 0; axis < 3; ++axis) {
              const int first = static_cast<int>(floorf((c[axis] - s.radius) * inverse));
              counts = counts && cell[axis] == max(lo[axis], first);
            }
            if (!counts) continue;
            ++pairs;
            const float d = sqrtf(d2), step = s.radius - w.radius, depth = sum - d;
            volume += d <= step ? 4.18879f * w.radius * w.radius * w.radius
                                : 0.261799f * depth * depth * (d2 + 2 * d * sum - 3 * step * step) / d;
          }
        }
      }
    }
  }
}

__global__ void traverseAll(View a, View b, const Pose* poses, Sum* sums) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  float volume = 0;
  unsigned pairs = 0;
  if (i < a.count) {
    traverse(a, b, poses[blockIdx.y].a_in_b, false, i, volume, pairs);
  } else if (i < a.count + b.count) {
    traverse(b, a, poses[blockIdx.y].b_in_a, true, i - a.count, volume, pairs);
  }
  for (int step = 16; step > 0; step /= 2) {
    volume += __shfl_xor_sync(0xffffffffu, volume, step);
    pairs += __shfl_xor_sync(0xffffffffu, pairs, step);
  }
  if (threadIdx.x % 32 != 0 || pairs == 0) return;
  atomicAdd(&sums[blockIdx.y].volume, static_cast<double>(volume));
  atomicAdd(&sums[blockIdx.y].pairs, static_cast<unsigned long long>(pairs));
}

View viewOf(const PaperGrid& grid, const Sphere* spheres, const PaperGrid::Bucket* buckets) {
  View view{};
  std::fill_n(view.lo, 3, std::numeric_limits<float>::max());
  std::fill_n(view.hi, 3, std::numeric_limits<float>::lowest());
  for (const Sphere& s : grid.spheres()) {
    const float c[3] = {s.x, s.y, s.z};
    for (int axis = 0; axis < 3; ++axis) {
      view.lo[axis] = std::min(view.lo[axis], c[axis] - s.radius);
      view.hi[axis] = std::max(view.hi[axis], c[axis] + s.radius);
    }
  }
  view.spheres = spheres;
  view.buckets = buckets;
  view.count = static_cast<unsigned>(grid.spheres().size());
  view.mask = static_cast<unsigned>(grid.buckets().size() - 1);
  view.finest = grid.finest();
  view.coarsest = grid.coarsest();
  return view;
}

double median(std::vector<double>& times) {
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

}  // namespace

PaperCuda runPaperOnDevice(const PaperGrid& a, const PaperGrid& b, const std::vector<PaperPose>& poses,
                           std::size_t runs) {
  const OnDevice<Sphere> spheres_a(a.spheres()), spheres_b(b.spheres());
  const OnDevice<PaperGrid::Bucket> buckets_a(a.buckets()), buckets_b(b.buckets());
  const View view_a = viewOf(a, spheres_a.get(), buckets_a.get()),
             view_b = viewOf(b, spheres_b.get(), buckets_b.get());
  std::vector<Pose> given;
  for (const PaperPose& pose : poses) given.push_back({toTransform(pose.a_in_b), toTransform(pose.b_in_a)});
  std::vector<Sum> result(poses.size());
  const OnDevice<Pose> device_poses(given.size());
  const OnDevice<Sum> sums(result.size());
  cudaEvent_t start, stop;
  check(cudaEventCreate(&start));
  check(cudaEventCreate(&stop));
  std::vector<double> kernel, host;
  const dim3 blocks((view_a.count + view_b.count + 127) / 128, static_cast<unsigned>(poses.size()));
  for (std::size_t run = 0; run <= runs; ++run) {
    const auto begin = std::chrono::steady_clock::now();
    check(cudaMemcpyAsync(device_poses.get(), given.data(), given.size() * sizeof(Pose), cudaMemcpyDefault));
    check(cudaMemsetAsync(sums.get(), 0, result.size() * sizeof(Sum)));
    check(cudaEventRecord(start));
    traverseAll<<<blocks, 128>>>(view_a, view_b, device_poses.get(), sums.get());
    check(cudaGetLastError());
    check(cudaEventRecord(stop));
    check(cudaMemcpy(result.data(), sums.get(), result.size() * sizeof(Sum), cudaMemcpyDefault));
    const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - begin;
    float milliseconds = 0;
    check(cudaEventElapsedTime(&milliseconds, start, stop));
    if (run == 0) continue;  // warm up
    host.push_back(time.count());
    kernel.push_back(1e3 * static_cast<double>(milliseconds));
  }
  cudaEventDestroy(start);
  cudaEventDestroy(stop);
  return {median(kernel), median(host), static_cast<std::size_t>(result[0].pairs), result[0].volume};
}

}  // namespace innersphere::benchmarks
