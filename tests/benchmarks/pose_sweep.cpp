// Time a pose of a sweep, beside a batch of queries: poses and results in memory of the host, pinned, and of
// the device; in a stream of the user's; and over all devices. Or one long sweep, and the memory that it
// takes.
#include <cuda_runtime.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
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

/// Sweeps in a stream, to their end; and how long the host is at it, for all poses.
void streamed(QueryContext& context, const PairQuery& pair, const QueryOptions& options, std::size_t count,
              std::size_t runs, const double* poses, Overlap* overlaps) {
  cudaStream_t stream = nullptr;
  cudaStreamCreate(&stream);
  std::vector<double> started;
  column(count, runs, [&] {
    started.push_back(timeOf([&] {
      context.startSweep(pair, {count, poses, nullptr, nullptr}, options, overlaps, stream);
    }));
    context.waitSweep();
  });
  std::printf(" %.0f (%.0f) |", median(started), quantile(started, 0.99));
  cudaStreamDestroy(stream);
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
    streamed(one, pair, options, count, runs, device_poses, on_device);
    sweep(all, matrices.data(), overlaps.data());
    sweep(all, pinned_poses, pinned);
    std::printf("\n");
  }
  cudaFreeHost(pinned_poses);
  cudaFreeHost(pinned);
  cudaFree(device_poses);
  cudaFree(on_device);
}

double freeMemory() {
  std::size_t free = 0, all = 0;
  cudaMemGetInfo(&free, &all);
  return static_cast<double>(free);
}

/// Poses that no memory of a device has to hold. Quaternions turn about one axis.
void longSweep(std::size_t spheres, std::size_t count) {
  const CollisionModel a(benchmarks::greedyBall(spheres, 1)), b(benchmarks::greedyBall(spheres, 2));
  PairQuery pair;
  pair.a = &a;
  pair.b = &b;
  std::vector<double> positions(3 * count), quaternions(4 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count);
    positions[3 * i] = 1.6 + 0.4 * share;  // from an overlap to none
    quaternions[4 * i + 2] = std::sin(3 * share);
    quaternions[4 * i + 3] = std::cos(3 * share);
  }
  std::vector<Overlap> overlaps(count);
  QueryContext context({Backend::cuda});
  context.sweep(pair, {1, nullptr, positions.data(), quaternions.data()}, {}, overlaps.data());
  const double before = freeMemory();
  const double time = timeOf([&] {
    context.sweep(pair, {count, nullptr, positions.data(), quaternions.data()}, {}, overlaps.data());
  });
  const double taken = before - freeMemory();
  std::size_t touching = 0, wrong = 0, checked = 0;
  for (const Overlap& overlap : overlaps) touching += overlap.pair_count > 0;
  for (std::size_t i = 0; i < count; i += count / 97 + 1, ++checked) {
    Overlap alone;
    context.sweep(pair, {1, nullptr, positions.data() + 3 * i, quaternions.data() + 4 * i}, {}, &alone);
    wrong += std::memcmp(&alone, &overlaps[i], sizeof alone) != 0;
  }
  std::printf(
      "%zu poses of %zu spheres: %.2f s, %.3f us a pose; %.0f MiB of the device; %zu touch; of %zu asked for "
      "alone, %zu differ\n",
      count, spheres, 1e-6 * time, time / static_cast<double>(count), taken / (1 << 20), touching, checked,
      wrong);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Time a pose of a sweep.");
  std::vector<std::size_t> spheres{4000, 60000};
  std::size_t poses = 100000, runs = 11, long_sweep = 0;
  app.add_option("--spheres", spheres, "Of both bodies")->delimiter(',');
  app.add_option("--poses", poses, "Of a sweep");
  app.add_option("--runs", runs, "Of each kind");
  app.add_option("--long", long_sweep, "Only one sweep, of so many poses");
  CLI11_PARSE(app, argc, argv);
  std::printf("%s\n", benchmarks::heading("Sweeps of poses", argc, argv).c_str());
  cudaDeviceProp properties{};
  cudaGetDeviceProperties(&properties, 0);
  std::printf(
      "%d x %s. %zu poses a sweep. Microseconds a pose as the host sees it: median (p99) of %zu sweeps.\n\n",
      cudaDeviceCount(), properties.name, poses, runs);
  if (long_sweep > 0) {
    for (const std::size_t count : spheres) longSweep(count, long_sweep);
    return 0;
  }
  std::printf(
      "| spheres | overlap | batch of queries | sweep | pinned | on the device | in a stream | of all, the "
      "host's | all devices | all, pinned |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|---|\n");
  for (const std::size_t count : spheres) measure(count, count > 20000 ? poses / 10 : poses, runs);
  return 0;
}
