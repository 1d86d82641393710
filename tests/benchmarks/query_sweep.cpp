// The paper's sweep of poses: one solid stands still, a turned copy is shifted by half of its size.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "greedy_ball.hpp"
#include "innersphere/error.hpp"
#include "innersphere/query.hpp"
#include "machine.hpp"
#include "source.hpp"
#include "sweep.hpp"
#include "timing.hpp"

namespace {

using namespace innersphere;
using namespace innersphere::benchmarks;

constexpr QueryOptions kQuery{Want::wrench, Estimator::raw};  // as in the paper, and its torque

struct Arguments {
  std::vector<std::string> sources;
  std::vector<std::size_t> counts = {4000, 10000, 20000, 40000, 60000};
  std::vector<std::size_t> ball = {4000, 60000, 250000, 1000000};
  std::size_t poses = 72, passes = 5;
  std::string backend = "all", points, device;
};

struct Run {
  const char* name;
  Backend backend;
};

struct Scene {
  std::string name;
  std::shared_ptr<const Packing> packing;
};

class Sweep {
 public:
  explicit Sweep(const Arguments& arguments) : arguments_(arguments) {
    if (arguments.backend != "cuda") runs_.push_back({"CPU", Backend::cpu});
    if (arguments.backend == "cuda" || (arguments.backend == "all" && cudaAvailable()))
      runs_.push_back({"CUDA", Backend::cuda});
    if (arguments.points.empty()) return;
    points_.reset(std::fopen(arguments.points.c_str(), "w"));
    if (!points_) throw Error(ErrorCode::write_failed, "cannot write " + arguments.points);
    std::fprintf(points_.get(), "# solid spheres backend angle[deg] time[us] kernels[us] pairs\n");
  }

  void rows(const Scene& scene, const std::vector<std::size_t>& counts) {
    const CollisionModel model(scene.packing);
    for (const std::size_t count : counts) {
      for (const Run& run : runs_) row(scene, model, count, run);
    }
  }

 private:
  void row(const Scene& scene, const CollisionModel& model, std::size_t count, const Run& run) {
    const std::size_t n = arguments_.poses;
    const bool cuda = run.backend == Backend::cuda;
    const auto prefix = static_cast<std::uint32_t>(count);
    std::vector<PairQuery> queries;
    for (const Placement& pose : sweepPoses(boxOf(*scene.packing), {0, 0, 1}, n))
      queries.push_back({&model, &model, {}, pose, prefix, prefix, 0});
    QueryContext context({run.backend, 1}), timed({run.backend, 1, true});
    std::vector<double> pairs(n), kernels(n, 0);
    const std::vector<double> times = leastTimes(n, arguments_.passes, [&](std::size_t i) {
      pairs[i] = static_cast<double>(context.overlap(queries[i], kQuery).pair_count);
    });
    for (std::size_t pass = 0; cuda && pass < arguments_.passes; ++pass) {
      for (std::size_t i = 0; i < n; ++i) {
        timed.overlap(queries[i], kQuery);
        const double kernel = 1e6 * timed.kernelTime();
        kernels[i] = pass == 0 ? kernel : std::min(kernels[i], kernel);
      }
    }
    std::printf("| %s | %zu | %s | %.0f | %.1f | %.1f | %.2f |", scene.name.c_str(), count, run.name,
                median(pairs), median(times), quantile(times, 1), quantile(times, 1) / median(times));
    if (cuda) std::printf(" %.1f | %.1f |", median(kernels), quantile(kernels, 1));
    std::printf("%s %.2f |\n", cuda ? "" : " - | - |", construction(scene, queries[0], context));
    std::fflush(stdout);
    for (std::size_t i = 0; points_ && i < n; ++i) {
      std::fprintf(points_.get(), "%s %zu %s %g %g %g %g\n", scene.name.c_str(), count, run.name,
                   360.0 * static_cast<double>(i) / static_cast<double>(n), times[i], kernels[i], pairs[i]);
    }
  }

  /// From so many spheres to the first answer, which needs one grid [ms].
  double construction(const Scene& scene, PairQuery query, QueryContext& context) const {
    const auto packing = std::make_shared<Packing>();
    packing->spheres.assign(scene.packing->spheres.begin(), scene.packing->spheres.begin() + query.prefix_a);
    return 1e-3 * leastTimes(1, arguments_.passes, [&](std::size_t) {
             const CollisionModel model(packing);
             query.a = query.b = &model;
             context.overlap(query, {Want::touch, Estimator::raw});
           })[0];
  }

  const Arguments& arguments_;
  std::vector<Run> runs_;
  std::unique_ptr<FILE, int (*)(FILE*)> points_{nullptr, std::fclose};
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Query time over a sweep of poses: a solid stands still, a copy is turned about z and shifted by half "
      "of "
      "its size along x. Plain radii, volume and wrench; one thread on the CPU. A Markdown table on stdout.");
  Arguments arguments;
  app.add_option("--mesh,SOLID", arguments.sources,
                 "Mesh files, packing files or names of solids (default: torus gear bolt)");
  app.add_option("--spheres", arguments.counts, "Numbers of spheres of each solid")
      ->capture_default_str()
      ->delimiter(',');
  app.add_option("--ball", arguments.ball, "Numbers of spheres of a greedily filled ball; 0: none")
      ->capture_default_str()
      ->delimiter(',');
  app.add_option("--poses", arguments.poses)->capture_default_str()->check(CLI::PositiveNumber);
  app.add_option("--passes", arguments.passes, "Each time is the least of so many runs")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--backend", arguments.backend, "all: cuda where a device is found")
      ->capture_default_str()
      ->check(CLI::IsMember({"all", "cpu", "cuda"}));
  app.add_option("--points", arguments.points, "Write the time of each pose there, for plots");
  app.add_option("--device", arguments.device, "Name of the GPU, for the head of the table");
  CLI11_PARSE(app, argc, argv);
  if (arguments.sources.empty()) arguments.sources = {"torus", "gear", "bolt"};
  try {
    Sweep sweep(arguments);
    std::printf("%s", heading("Sweep of poses", argc, argv).c_str());
    if (!arguments.device.empty()) std::printf("GPU: %s\n\n", arguments.device.c_str());
    std::printf(
        "| solid | spheres | backend | pairs, median | median us | worst us | worst over median | kernels: "
        "median "
        "us | worst us | construction ms |\n|---|---|---|---|---|---|---|---|---|---|\n");
    const std::size_t most = *std::max_element(arguments.counts.begin(), arguments.counts.end());
    for (const std::string& source : arguments.sources)
      sweep.rows({plainName(source), packingFrom(source, most)}, arguments.counts);
    for (const std::size_t count : arguments.ball) {
      if (count > 0) sweep.rows({"ball", greedyBall(count, 1)}, {count});
    }
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
