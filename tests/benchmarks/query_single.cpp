// Time of one pair on a device: the paper's query, one launch for each, and a kernel that stays.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "greedy_ball.hpp"
#include "innersphere/error.hpp"
#include "innersphere/query.hpp"
#include "machine.hpp"
#include "paper_grid_cuda.hpp"
#include "timing.hpp"

namespace {

using namespace innersphere;
using benchmarks::quantile;

struct Depth {
  const char* name;
  double distance;  ///< of the centres of two unit balls
};
constexpr Depth kDepths[] = {{"deep, 81 % shared", 0.25}, {"half, 31 %", 1.0}, {"light, 1.5 %", 1.8}};

struct Arguments {
  std::vector<std::size_t> spheres{4000, 60000};
  std::size_t runs = 20001, poses = 1000;
  double pause = 0;  // us
};

Mat3d turned(double about_z, double about_y) {
  const double c = std::cos(about_z), s = std::sin(about_z), cy = std::cos(about_y), sy = std::sin(about_y);
  return {c * cy, -s, c * sy, s * cy, c, s * sy, -sy, 0, cy};
}

/// A body that turns in small steps, as in a control loop.
std::vector<PairQuery> queriesAt(const CollisionModel& a, const CollisionModel& b, const Depth& depth,
                                 std::size_t count) {
  std::vector<PairQuery> queries(count);
  for (std::size_t i = 0; i < count; ++i) {
    queries[i].a = &a;
    queries[i].b = &b;
    queries[i].placement_b.rotation =
        turned(0.7 + 0.5 * static_cast<double>(i) / static_cast<double>(count), 0.4);
    queries[i].placement_b.translation = {0.8 * depth.distance, 0.6 * depth.distance, 0};
  }
  return queries;
}

void waitFor(double microseconds) {
  const auto start = std::chrono::steady_clock::now();
  while (std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count() <
         microseconds)
    continue;
}

std::vector<Overlap> column(QueryContext& context, const std::vector<PairQuery>& queries,
                            const Arguments& arguments) {
  std::vector<Overlap> overlaps(queries.size());
  std::vector<double> times;
  for (std::size_t run = 0; run < arguments.runs + queries.size(); ++run) {
    const std::size_t i = run % queries.size();
    if (arguments.pause > 0) waitFor(arguments.pause);
    const double time = benchmarks::timeOf([&] {
      overlaps[i] = context.overlap(queries[i], {Want::wrench, Estimator::raw});
    });
    if (run >= queries.size()) times.push_back(time);
  }
  std::printf(" %.1f (%.1f, %.1f) |", quantile(times, 0.5), quantile(times, 0.99), quantile(times, 0.999));
  std::fflush(stdout);
  return overlaps;
}

void rows(const Arguments& arguments, std::size_t spheres) {
  const CollisionModel a(benchmarks::greedyBall(spheres, 1)), b(benchmarks::greedyBall(spheres, 2));
  const benchmarks::PaperGrid grid_a(a.packing().spheres), grid_b(b.packing().spheres);
  QueryContextOptions options;
  options.backend = Backend::cuda;
  QueryContext launched(options);
  options.resident_seconds = 0.01;
  QueryContext resident(options);
  for (const Depth& depth : kDepths) {
    const std::vector<PairQuery> queries = queriesAt(a, b, depth, arguments.poses);
    const Placement& place = queries[0].placement_b;
    Placement inverse;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        inverse.rotation[3 * i + j] = place.rotation[3 * j + i];
        inverse.translation[static_cast<int>(i)] -=
            place.rotation[3 * j + i] * place.translation[static_cast<int>(j)];
      }
    }
    const benchmarks::PaperCuda paper = benchmarks::runPaperOnDevice(grid_a, grid_b, {{inverse, place}}, 101);
    std::printf("| %zu | %s | %.1f |", spheres, depth.name, paper.host);
    const std::vector<Overlap> expected = column(launched, queries, arguments);
    const std::vector<Overlap> found = column(resident, queries, arguments);
    const bool same = std::memcmp(expected.data(), found.data(), found.size() * sizeof(Overlap)) == 0;
    std::printf(" %s |\n", same ? "same" : "NOT THE SAME");
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Time of one pair on a device, as a Markdown table on stdout; microseconds as the host sees them");
  Arguments arguments;
  app.add_option("--spheres", arguments.spheres, "Of both bodies")->capture_default_str()->delimiter(',');
  app.add_option("--runs", arguments.runs, "Queries of each kind")->capture_default_str();
  app.add_option("--poses", arguments.poses, "That they go through")->capture_default_str();
  app.add_option("--pause", arguments.pause, "Between queries [us]")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    std::printf("%s", benchmarks::heading("One pair on a device", argc, argv).c_str());
    std::printf(
        "Median (99th, 99.9th percentile) of %zu queries, wrench, pauses of %.0f us; the paper's query: "
        "volume.\n\n"
        "| spheres | overlap | paper | launched | resident | bits |\n|---|---|---|---|---|---|\n",
        arguments.runs, arguments.pause);
    for (const std::size_t count : arguments.spheres) rows(arguments, count);
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
