// A body that bends in each step, against a rigid one, a thousand times a second: the spheres are skinned to
// a moving frame, the grid is built anew, and the overlap is asked for.
#include <tbb/parallel_for.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <vector>

#include "greedy_ball.hpp"
#include "innersphere/error.hpp"
#include "innersphere/query.hpp"
#include "machine.hpp"
#include "timing.hpp"

namespace {

using namespace innersphere;
using namespace innersphere::benchmarks;

/// Blends two frames along z: the upper end of the body leans by `angle` about y, the lower one stays.
void skin(const std::vector<Sphere>& rest, double angle, std::vector<Sphere>& bent) {
  constexpr std::size_t kGrain = 2048;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rest.size(), kGrain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const Sphere& s = rest[i];
      const float turn = static_cast<float>(angle) * (s.z + 1) / 2;
      const float c = std::cos(turn), n = std::sin(turn);
      bent[i] = {c * s.x + n * (s.z + 1), s.y, c * (s.z + 1) - n * s.x - 1, s.radius};
    }
  });
}

void row(const char* name, Backend backend, std::size_t spheres, std::size_t steps) {
  const auto packing = greedyBall(spheres, 1);
  CollisionModel bending(packing);
  const CollisionModel rigid(greedyBall(spheres, 2));
  PairQuery pair;
  pair.a = &rigid;
  pair.b = &bending;
  pair.placement_b.translation = {0.8, 0.6, 0};
  QueryContext context({backend});
  std::vector<Sphere> bent = packing->spheres;
  std::vector<double> all, skinning, updating, asking;
  double least = 1e300, most = 0;
  constexpr std::size_t kWarm = 20;
  for (std::size_t step = 0; step < steps + kWarm; ++step) {
    const double angle = 0.4 * std::sin(2e-3 * static_cast<double>(step));
    Overlap overlap;
    const double skinned = timeOf([&] { skin(packing->spheres, angle, bent); });
    const double updated = timeOf([&] { bending.update(bent.data(), bent.size()); });
    const double asked = timeOf([&] { overlap = context.overlap(pair, {Want::wrench, Estimator::raw}); });
    least = std::min(least, overlap.volume);
    most = std::max(most, overlap.volume);
    if (step < kWarm) continue;
    skinning.push_back(skinned);
    updating.push_back(updated);
    asking.push_back(asked);
    all.push_back(skinned + updated + asked);
  }
  std::size_t late = 0;
  for (const double time : all) late += time > 1000;
  std::printf("| %s | %zu | %.0f | %.0f | %.0f | %.0f | %.0f | %.0f | %.2f %% | %.2f to %.2f |\n", name,
              spheres, median(skinning), median(updating), median(asking), median(all), quantile(all, 0.99),
              quantile(all, 1), 100.0 * static_cast<double>(late) / static_cast<double>(all.size()), least,
              most);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("A body that bends, at 1 kHz, as a Markdown table on stdout");
  std::vector<std::size_t> counts = {15000, 60000};
  std::size_t steps = 10000;
  std::string device;
  app.add_option("--device", device, "Name of the GPU, for the head of the table");
  app.add_option("--spheres", counts, "Numbers of spheres of each body")
      ->capture_default_str()
      ->delimiter(',');
  app.add_option("--steps", steps, "Steps of a millisecond")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    std::printf("%s", heading("A body that bends", argc, argv).c_str());
    if (!device.empty()) std::printf("GPU: %s\n\n", device.c_str());
    std::printf(
        "Microseconds of a step: medians of its parts; median, 99th percentile and longest of the whole; and "
        "how many "
        "take more than a millisecond.\n\n"
        "| backend | spheres | skin | update | build and query | step | p99 | longest | late | shared "
        "volume, m^3 "
        "|\n|---|---|---|---|---|---|---|---|---|---|\n");
    for (const std::size_t count : counts) {
      row("CPU", Backend::cpu, count, steps / 10);
      if (cudaAvailable()) row("CUDA", Backend::cuda, count, steps);
    }
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
