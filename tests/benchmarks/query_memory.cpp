// Memory of the GPU: what packings, their grids and a context's scratch take there, and whether all comes
// back.
#include <cuda_runtime.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <vector>

#include "greedy_ball.hpp"
#include "innersphere/error.hpp"
#include "innersphere/query.hpp"
#include "machine.hpp"

namespace {

using namespace innersphere;
using namespace innersphere::benchmarks;

/// Bytes in use on the device, in steps of the 2 MiB that it gives out.
double used() {
  cudaDeviceSynchronize();
  std::size_t left = 0, all = 0;
  cudaMemGetInfo(&left, &all);
  return static_cast<double>(all - left);
}

constexpr double kMiB = 1 << 20;

/// Many models of one packing, so that the device's steps do not matter.
void row(std::size_t spheres, std::size_t models, std::size_t batch) {
  const auto packing = greedyBall(spheres, 1);
  const double packings = static_cast<double>(models * spheres * sizeof(Sphere));
  const double before = used();
  double grids, scratch;
  {
    std::vector<std::unique_ptr<CollisionModel>> all;
    for (std::size_t i = 0; i < models; ++i) all.push_back(std::make_unique<CollisionModel>(packing));
    std::vector<PairQuery> queries;
    for (std::size_t i = 0; i < std::max(models, batch); ++i) {
      PairQuery query{all[i % models].get(), all[(i + 1) % models].get(), {}, {}, 0, 0, 0};
      query.placement_b.translation = {0.8, 0.6, 1e-4 * static_cast<double>(i)};
      queries.push_back(query);
    }
    double with_scratch;
    {
      QueryContext context({Backend::cuda});
      QueryResult result;
      const std::size_t step = batch;
      for (std::size_t i = 0; i < queries.size(); i += step)
        context.run(&queries[i], std::min(step, queries.size() - i), {Want::wrench, Estimator::raw}, result);
      with_scratch = used() - before;
    }
    grids = used() - before;
    scratch = with_scratch - grids;
  }
  std::printf("| %zu | %zu | %zu | %.1f | %.1f | %.2f | %.1f | %.1f |\n", spheres, models, batch,
              packings / kMiB, grids / kMiB, grids / packings, scratch / kMiB, (used() - before) / kMiB);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Memory of the GPU in use, as the driver counts it. A Markdown table on stdout.");
  std::string device;
  app.add_option("--device", device, "Name of the GPU, for the head of the table");
  CLI11_PARSE(app, argc, argv);
  try {
    std::printf("%s", heading("Memory of the GPU", argc, argv).c_str());
    if (!device.empty()) std::printf("GPU: %s\n\n", device.c_str());
    const auto warm = greedyBall(1000, 1);  // what the driver keeps for code and queues comes first
    const CollisionModel model(warm);
    QueryContext({Backend::cuda}).overlap({&model, &model, {}, {}, 0, 0, 0});
    std::printf(
        "Packings: 16 bytes a sphere. With grids: all that stays when no context is left. Half overlap.\n\n"
        "| spheres | packings | pairs at once | packings MiB | with grids MiB | over the packings | scratch "
        "of a "
        "context MiB | left at the end MiB |\n|---|---|---|---|---|---|---|---|\n");
    for (const std::size_t spheres : {4000, 60000, 250000}) {
      for (const std::size_t batch : {1, 1024}) row(spheres, 6000000 / spheres, batch);
    }
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
