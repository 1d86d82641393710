// Queries within a budget of time: how long they take, how exact they say they are, and how exact they are.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "innersphere/bounded_query.hpp"
#include "innersphere/error.hpp"
#include "machine.hpp"
#include "source.hpp"
#include "sweep.hpp"
#include "timing.hpp"

namespace {

using namespace innersphere;
using namespace innersphere::benchmarks;

constexpr double kLeast = 0.01;  // of the solid: errors relative to less say little

struct Arguments {
  std::vector<std::string> sources{"torus", "gear", "bolt"};
  std::vector<double> budgets{50, 100, 200, 500, 1000};
  std::size_t spheres = 16384, poses = 1000;
  std::string backend = "cpu", device;
};

struct Column {
  std::vector<double> times, prefixes, stated, measured;
  std::size_t late = 0;
};

/// A body that moves slowly through the sweep, as in a control loop. A budget of 0: as long as it takes.
Column follow(const CollisionModel& model, const std::vector<Placement>& poses, double budget,
              const std::vector<double>& volumes, Backend backend) {
  QueryContext context({backend, 1});
  BoundedQuery bounded(context);
  PairQuery query{&model, &model, {}, poses[0], 0, 0, 0};
  bounded.warmUp(query);
  Column column;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    query.placement_b = poses[i];
    BoundedOverlap result;
    column.times.push_back(timeOf([&] { result = bounded.overlap(query, {1e-6 * budget, 0}); }));
    column.late += budget > 0 && column.times.back() > budget;
    column.prefixes.push_back(result.prefix_a);
    if (volumes[i] < kLeast * model.packing().solid.volume || std::isnan(result.error)) continue;
    column.stated.push_back(result.error);
    column.measured.push_back(std::fabs(result.overlap.volume / volumes[i] - 1));
  }
  return column;
}

double meanOf(const std::vector<double>& values) {
  double sum = 0;
  for (const double x : values) sum += x;
  return sum / static_cast<double>(values.size());
}

void rows(const Arguments& arguments, const std::string& source) {
  const auto packing = packingFrom(source, arguments.spheres);
  const CollisionModel model(packing);
  const Backend backend = arguments.backend == "cuda" ? Backend::cuda : Backend::cpu;
  const std::vector<Placement> poses = sweepPoses(boxOf(*packing), {0, 0, 1}, arguments.poses);
  std::vector<double> volumes;
  QueryContext context({backend, 1});
  for (const Placement& pose : poses)
    volumes.push_back(context.overlap({&model, &model, {}, pose, 0, 0, 0}).volume);
  std::vector<double> budgets = arguments.budgets;
  budgets.push_back(0);
  for (const double budget : budgets) {
    const Column c = follow(model, poses, budget, volumes, backend);
    const double middle = median(c.times), worst = quantile(c.times, 1);
    std::printf("| %s | ", plainName(source).c_str());
    std::printf(budget > 0 ? "%.0f" : "none", budget);
    std::printf(" | %.1f | %.1f | %.1f | %.1f | %.2f | %zu | %.0f | %.0f | %.2f | %.2f |\n", middle,
                quantile(c.times, 0.99), quantile(c.times, 0.999), worst, worst / middle, c.late,
                median(c.prefixes), quantile(c.prefixes, 0), 100 * meanOf(c.stated),
                100 * meanOf(c.measured));
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Queries within a budget of time, over a sweep of poses in small steps: one thread, volume-true radii, "
      "volume "
      "and wrench. A Markdown table on stdout.");
  Arguments arguments;
  app.add_option("SOLID", arguments.sources, "Mesh files, packing files or names of solids")
      ->capture_default_str();
  app.add_option("--budgets", arguments.budgets, "[us]")
      ->capture_default_str()
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  app.add_option("--spheres", arguments.spheres)->capture_default_str()->check(CLI::PositiveNumber);
  app.add_option("--poses", arguments.poses)->capture_default_str()->check(CLI::PositiveNumber);
  app.add_option("--backend", arguments.backend)
      ->capture_default_str()
      ->check(CLI::IsMember({"cpu", "cuda"}));
  app.add_option("--device", arguments.device, "Name of the GPU, for the head of the table");
  CLI11_PARSE(app, argc, argv);
  try {
    std::printf("%s", heading("Queries within a budget of time", argc, argv).c_str());
    if (!arguments.device.empty()) std::printf("GPU: %s\n\n", arguments.device.c_str());
    std::printf(
        "Wall times in us. Errors where the overlap is over 1 %% of the solid: stated by the queries, and "
        "measured against all "
        "spheres.\n\n"
        "| solid | budget | median | 99 %% | 99.9 %% | worst | worst over median | late | spheres of each, "
        "median | "
        "fewest | error stated, %% | measured, %% |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const std::string& source : arguments.sources) rows(arguments, source);
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
