// The hash grid of the query beside a tree, on a device: time of a pair and in a batch, of construction, and
// memory.
#include <cuda_runtime.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "cuda/device_grid.hpp"
#include "greedy_ball.hpp"
#include "innersphere/error.hpp"
#include "innersphere/query.hpp"
#include "machine.hpp"
#include "sphere_bvh.hpp"
#include "timing.hpp"

namespace {

using namespace innersphere;
using namespace innersphere::benchmarks;

struct Depth {
  const char* name;
  double distance;  ///< of the centres of two unit balls
};
constexpr Depth kDepths[] = {{"deep, 81 % shared", 0.25}, {"half, 31 %", 1.0}, {"light, 1.5 %", 1.8}};

double freeMemory() {
  std::size_t free = 0, all = 0;
  INNERSPHERE_CUDA(cudaMemGetInfo(&free, &all));
  return static_cast<double>(free);
}

Placement poseAt(double distance, std::size_t number) {
  const double c = std::cos(0.7), s = std::sin(0.7);
  Placement pose;
  pose.rotation = {c, -s, 0, s, c, 0, 0, 0, 1};
  pose.translation = {0.8 * distance, 0.6 * distance, 1e-4 * static_cast<double>(number)};
  return pose;
}

/// Median times for a pose [us], kernels and host, of the tree and of the grid.
struct Row {
  double tree_kernel, tree_host, grid_kernel, grid_host;
};

Row timesOf(const CollisionModel& a, const CollisionModel& b, const SphereBvh& tree_a,
            const SphereBvh& tree_b, double distance, std::size_t count, std::size_t runs) {
  PairQuery pair;
  pair.a = &a;
  pair.b = &b;
  std::vector<PairQuery> queries(count, pair);
  std::vector<core::Frame> frames;
  for (std::size_t i = 0; i < count; ++i) {
    const Placement pose = queries[i].placement_b = poseAt(distance, i);
    core::Frame frame{{{1, 0, 0, 0, 1, 0, 0, 0, 1}}, {}, 1, 1, 0, 0, pose.translation};
    std::copy(pose.rotation.begin(), pose.rotation.end(), frame.matrix_b.m);
    frames.push_back(frame);
  }
  QueryContext timed({Backend::cuda, 0, true}), context({Backend::cuda});
  QueryResult result;
  const QueryOptions options{Want::volume, Estimator::raw};
  std::vector<double> times[4];
  for (std::size_t run = 0; run < runs + 2; ++run) {
    SphereBvh::Result of_tree;
    const double tree_host = timeOf([&] { of_tree = tree_b.overlap(tree_a, frames); });
    timed.run(queries.data(), count, options, result);
    const double grid_host = timeOf([&] { context.run(queries.data(), count, options, result); });
    if (run == 0) {
      for (std::size_t i = 0; i < count; ++i) {
        const Overlap& overlap = result.overlaps[i];
        if (of_tree.pairs[i] != overlap.pair_count ||
            std::fabs(of_tree.volumes[i] - overlap.volume) > 1e-9 * overlap.volume)
          throw Error(ErrorCode::bad_argument, "tree and grid differ");
      }
    }
    if (run < 2) continue;
    const double each[] = {1e6 * of_tree.kernel, tree_host, 1e6 * timed.kernelTime(), grid_host};
    for (int k = 0; k < 4; ++k) times[k].push_back(each[k] / static_cast<double>(count));
  }
  return {median(times[0]), median(times[1]), median(times[2]), median(times[3])};
}

void measure(std::size_t spheres, std::size_t batch, std::size_t runs) {
  const auto packing = greedyBall(spheres, 1);
  const CollisionModel model(packing);
  const double before = freeMemory();
  QueryContext warm({Backend::cuda});
  PairQuery self;
  self.a = self.b = &model;
  warm.overlap(self, {Want::touch, Estimator::raw});
  const double of_grid = before - freeMemory();
  SphereBvh tree(packing->spheres);
  std::vector<double> builds, grid_builds;
  {
    cudaStream_t stream = nullptr;
    INNERSPHERE_CUDA(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking));
    DeviceArray<Sphere> on_device;
    on_device.reserve(spheres);
    copyAsync(on_device.data(), packing->spheres.data(), spheres, stream);
    const core::GridPlan plan = planGrid(packing->spheres.data(), spheres);
    device::CudaGrid grid(0);
    Event start, stop;
    for (std::size_t run = 0; run < runs + 2; ++run) {
      builds.push_back(1e6 * tree.build());
      INNERSPHERE_CUDA(cudaEventRecord(start.get(), stream));
      grid.build(on_device.data(), plan, stream);
      INNERSPHERE_CUDA(cudaEventRecord(stop.get(), stream));
      INNERSPHERE_CUDA(cudaEventSynchronize(stop.get()));
      grid_builds.push_back(1e6 * secondsBetween(start, stop));
    }
    cudaStreamDestroy(stream);
  }
  for (const Depth& depth : kDepths) {
    const Row one = timesOf(model, model, tree, tree, depth.distance, 1, runs);
    const Row many =
        timesOf(model, model, tree, tree, depth.distance, batch, std::max<std::size_t>(5, runs / 5));
    std::printf("| %zu | %s | %.0f | %.0f | %.0f | %.0f | %.2f | %.2f | %.2f | %.2f |\n", spheres, depth.name,
                one.tree_kernel, one.tree_host, one.grid_kernel, one.grid_host, many.tree_kernel,
                many.tree_host, many.grid_kernel, many.grid_host);
    std::fflush(stdout);
  }
  std::printf("| %zu | construction %.0f (tree), %.0f (grid) us; memory %.1f, %.1f MiB | | | | | | | | |\n",
              spheres, median(builds), median(grid_builds), static_cast<double>(tree.bytes()) / 1048576,
              of_grid / 1048576);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("The hash grid beside a tree, as a Markdown table on stdout");
  std::vector<std::size_t> counts = {4000, 60000, 250000};
  std::size_t batch = 64, runs = 31;
  app.add_option("--spheres", counts, "Numbers of spheres")->capture_default_str()->delimiter(',');
  app.add_option("--batch", batch, "Pairs in a batch")->capture_default_str();
  app.add_option("--runs", runs, "Repetitions")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    cudaDeviceProp properties{};
    INNERSPHERE_CUDA(cudaGetDeviceProperties(&properties, 0));
    std::printf("%s%s. Medians, us a pair; volume only. Batch: %zu pairs.\n\n",
                heading("Hash or tree", argc, argv).c_str(), properties.name, batch);
    std::printf(
        "| spheres | overlap | one: tree, kernel | tree, host | grid, kernel | grid, host | batch: tree, "
        "kernel | "
        "tree, host | grid, kernels | grid, host |\n|---|---|---|---|---|---|---|---|---|---|\n");
    for (const std::size_t count : counts) measure(count, batch, runs);
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
