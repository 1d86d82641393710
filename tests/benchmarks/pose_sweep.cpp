// Time a pose of a sweep, beside a batch of queries: poses and results in memory of the host, pinned, and of
// the device; and over all devices.
#include <cuda_runtime.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "greedy_ball.hpp"
#include "innersphere/query.hpp"
#include "machine.hpp"
#include "timing.hpp"

namespace {

using namespace innersphere;
using benchmarks::median;
using benchmarks::quantile;
using benchmarks::timeOf;

/// Memory that lives as long as the program.
template <typename T>
T* allocate(bool on_device, std::size_t count) {
  void* p = nullptr;
  const cudaError_t status =
      on_device ? cudaMalloc(&p, count * sizeof(T)) : cudaMallocHost(&p, count * sizeof(T));
  if (status != cudaSuccess) {
    std::fprintf(stderr, "no memory: %s\n", cudaGetErrorString(status));
    std::exit(1);
  }
  return static_cast<T*>(p);
}

struct Depth {
  const char* name;
  double distance;  ///< of the centres of two unit balls
};
constexpr Depth kDepths[] = {{"deep, 81 % shared", 0.25}, {"half, 31 %", 1.0}, {"light, 1.5 %", 1.8}};

/// Poses around a depth, turned about all axes, as matrices.
std::vector<double> posesOf(double distance, std::size_t count) {
  std::vector<double> matrices;
  matrices.reserve(16 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2.399963 * static_cast<double>(i),
                 height = 2 * (static_cast<double>(i) + 0.5) / static_cast<double>(count) - 1;
    const double flat = std::sqrt(1 - height * height), c = std::cos(angle), s = std::sin(angle);
    const double numbers[16] = {c, -s, 0, distance * flat * c, s, c, 0, distance * flat * s,
                                0, 0,  1, distance * height,   0, 0, 0, 1};
    matrices.insert(matrices.end(), numbers, numbers + 16);
  }
  return matrices;
}

void column(std::size_t count, std::size_t runs, const std::function<void()>& work) {
  work();
  std::vector<double> times(runs);
  for (double& time : times) time = timeOf(work) / static_cast<double>(count);
  std::printf(" %.3f (%.3f) |", median(times), quantile(times, 0.99));
  std::fflush(stdout);
}

void measure(std::size_t spheres, std::size_t count, std::size_t runs) {
  const CollisionModel a(benchmarks::greedyBall(spheres, 1)), b(benchmarks::greedyBall(spheres, 2));
  PairQuery pair;
  pair.a = &a;
  pair.b = &b;
  const QueryOptions options{Want::wrench, Estimator::raw};
  QueryContext one({Backend::cuda});
  QueryContextOptions all_devices;
  all_devices.backend = Backend::cuda;
  all_devices.device = kAllDevices;
  QueryContext all(all_devices);
  auto* pinned_poses = allocate<double>(false, 16 * count);
  auto* pinned = allocate<Overlap>(false, count);
  auto* device_poses = allocate<double>(true, 16 * count);
  auto* on_device = allocate<Overlap>(true, count);
  std::vector<Overlap> overlaps(count);
  for (const Depth& depth : kDepths) {
    const std::vector<double> matrices = posesOf(depth.distance, count);
    std::copy(matrices.begin(), matrices.end(), pinned_poses);
    cudaMemcpy(device_poses, matrices.data(), matrices.size() * sizeof(double), cudaMemcpyHostToDevice);
    std::printf("| %zu | %s |", spheres, depth.name);
    std::vector<PairQuery> queries(count, pair);
    QueryResult result;
    column(count, runs, [&] {
      for (std::size_t i = 0; i < count; ++i) {
        const double* m = matrices.data() + 16 * i;
        queries[i].placement_b.rotation = {m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]};
        queries[i].placement_b.translation = {m[3], m[7], m[11]};
      }
      one.run(queries.data(), count, options, result);
    });
    const auto sweep = [&](QueryContext& context, const double* poses, Overlap* to) {
      column(count, runs, [&] { context.sweep(pair, {count, poses, nullptr, nullptr}, options, to); });
    };
    sweep(one, matrices.data(), overlaps.data());
    sweep(one, pinned_poses, pinned);
    sweep(one, device_poses, on_device);
    sweep(all, matrices.data(), overlaps.data());
    sweep(all, pinned_poses, pinned);
    std::printf("\n");
  }
  cudaFreeHost(pinned_poses);
  cudaFreeHost(pinned);
  cudaFree(device_poses);
  cudaFree(on_device);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Time a pose of a sweep.");
  std::vector<std::size_t> spheres{4000, 60000};
  std::size_t poses = 100000, runs = 11;
  app.add_option("--spheres", spheres, "Of both bodies")->delimiter(',');
  app.add_option("--poses", poses, "Of a sweep");
  app.add_option("--runs", runs, "Of each kind");
  CLI11_PARSE(app, argc, argv);
  std::printf("%s\n", benchmarks::heading("Sweeps of poses", argc, argv).c_str());
  cudaDeviceProp properties{};
  cudaGetDeviceProperties(&properties, 0);
  std::printf(
      "%d x %s. %zu poses a sweep. Microseconds a pose as the host sees it: median (p99) of %zu sweeps.\n\n",
      cudaDeviceCount(), properties.name, poses, runs);
  std::printf(
      "| spheres | overlap | batch of queries | sweep | pinned | on the device | all devices | all, pinned "
      "|\n");
  std::printf("|---|---|---|---|---|---|---|---|\n");
  for (const std::size_t count : spheres) measure(count, count > 20000 ? poses / 10 : poses, runs);
  return 0;
}
