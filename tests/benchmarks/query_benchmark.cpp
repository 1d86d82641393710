// Time of overlap queries: three depths, alone and in batches, a sweep of poses, and the paper's own grid.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "greedy_ball.hpp"
#include "innersphere/error.hpp"
#include "innersphere/packing_file.hpp"
#include "innersphere/query.hpp"
#include "machine.hpp"
#include "paper_grid.hpp"
#ifdef INNERSPHERE_PAPER_CUDA
#include "paper_grid_cuda.hpp"
#endif

namespace {

using namespace innersphere;

struct Times {
  double median = 0, p99 = 0, worst = 0;  // microseconds
};

Times measure(std::size_t runs, const std::function<void()>& work) {
  work();  // warm up
  std::vector<double> times(runs);
  for (double& time : times) {
    const auto start = std::chrono::steady_clock::now();
    work();
    time = std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
  }
  std::sort(times.begin(), times.end());
  return {times[runs / 2], times[(runs - 1) * 99 / 100], times.back()};
}

Mat3d turned(double about_z, double about_y) {
  const double c = std::cos(about_z), s = std::sin(about_z), cy = std::cos(about_y), sy = std::sin(about_y);
  return {c * cy, -s, c * sy, s * cy, c, s * sy, -sy, 0, cy};
}

/// Two packings, B at a pose.
PairQuery queryOf(const CollisionModel& a, const CollisionModel& b, const Mat3d& rotation,
                  const Vec3d& shift) {
  PairQuery query;
  query.a = &a;
  query.b = &b;
  query.placement_b.rotation = rotation;
  query.placement_b.translation = shift;
  return query;
}

struct Scene {
  const char* name;
  double distance;  // of the centres of two unit balls
};
constexpr Scene kScenes[] = {{"deep, 81 % shared", 0.25}, {"half, 31 %", 1.0}, {"light, 1.5 %", 1.8}};

PairQuery sceneQuery(const CollisionModel& a, const CollisionModel& b, const Scene& scene,
                     double sideways = 0) {
  return queryOf(a, b, turned(0.7, 0.4), {0.8 * scene.distance, 0.6 * scene.distance, sideways});
}

const char* nameOf(Backend backend) {
  return backend == Backend::cuda ? "CUDA" : "CPU";
}

void scenes(QueryContext& context, Backend backend, const CollisionModel& a, const CollisionModel& b,
            std::size_t runs) {
  for (const Scene& scene : kScenes) {
    const PairQuery query = sceneQuery(a, b, scene);
    std::printf(
        "| %s | %s | %llu |", nameOf(backend), scene.name,
        static_cast<unsigned long long>(context.overlap(query, {Want::volume, Estimator::raw}).pair_count));
    QueryResult result;
    for (Want want : {Want::touch, Want::volume, Want::wrench, Want::contacts}) {
      const Times t = measure(runs, [&] { context.run(&query, 1, {want, Estimator::raw}, result); });
      std::printf(" %.1f (%.1f) |", t.median, t.p99);
    }
    std::printf("\n");
    std::fflush(stdout);
  }
}

std::vector<PairQuery> sceneBatch(const CollisionModel& a, const CollisionModel& b, const Scene& scene,
                                  std::size_t count) {
  std::vector<PairQuery> queries;
  for (std::size_t i = 0; i < count; ++i)
    queries.push_back(sceneQuery(a, b, scene, 1e-4 * static_cast<double>(i)));
  return queries;
}

/// Time of a batch of wrenches per pair, as the host sees it.
Times batchTime(QueryContext& context, const std::vector<PairQuery>& queries, std::size_t runs) {
  QueryResult result;
  const Times t = measure(runs, [&] {
    context.run(queries.data(), queries.size(), {Want::wrench, Estimator::raw}, result);
  });
  const auto pairs = static_cast<double>(queries.size());
  return {t.median / pairs, t.p99 / pairs, t.worst / pairs};
}

/// The device's share of it.
double kernelTime(QueryContext& context, const std::vector<PairQuery>& queries, std::size_t runs) {
  QueryResult result;
  std::vector<double> times(runs);
  for (double& time : times) {
    context.run(queries.data(), queries.size(), {Want::wrench, Estimator::raw}, result);
    time = 1e6 * context.kernelTime();
  }
  std::sort(times.begin(), times.end());
  return times[runs / 2] / static_cast<double>(queries.size());
}

/// Where the bodies of a scene are in each other's frame.
struct RelativePose {
  Placement b_in_a, a_in_b;
};

RelativePose relativePose(const Scene& scene, double sideways = 0) {
  RelativePose pose;
  const Mat3d r = turned(0.7, 0.4);
  const Vec3d t{0.8 * scene.distance, 0.6 * scene.distance, sideways};
  pose.b_in_a = {r, t, 1};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      pose.a_in_b.rotation[3 * i + j] = r[3 * j + i];
      pose.a_in_b.translation[i] -= r[3 * j + i] * t[j];
    }
  }
  return pose;
}

#ifdef INNERSPHERE_PAPER_CUDA
/// One pair and a batch: the paper's query as it is written there, and ours.
void devices(const CollisionModel& a, const CollisionModel& b, std::size_t batch, std::size_t runs) {
  QueryContext context({Backend::cuda}), timed({Backend::cuda, 0, true});
  const benchmarks::PaperGrid grid_a(a.packing().spheres), grid_b(b.packing().spheres);
  for (const std::size_t count : {std::size_t{1}, batch}) {
    const std::size_t repeats = count == 1 ? runs : std::max<std::size_t>(5, runs / 20);
    const auto pairs = static_cast<double>(count);
    for (const Scene& scene : kScenes) {
      std::vector<benchmarks::PaperPose> poses;
      for (std::size_t i = 0; i < count; ++i) {
        const RelativePose pose = relativePose(scene, 1e-4 * static_cast<double>(i));
        poses.push_back({pose.a_in_b, pose.b_in_a});
      }
      const benchmarks::PaperCuda paper = benchmarks::runPaperOnDevice(grid_a, grid_b, poses, repeats);
      const std::vector<PairQuery> queries = sceneBatch(a, b, scene, count);
      const Times host = batchTime(context, queries, repeats);
      const double kernel = kernelTime(timed, queries, repeats);
      std::printf("| %zu | %s | %.2f | %.2f | %.2f | %.2f (%.2f) |\n", count, scene.name,
                  paper.kernel / pairs, paper.host / pairs, kernel, host.median, host.p99);
      std::fflush(stdout);
    }
  }
}
#endif

/// From which size on a device is faster, and what Backend::automatic chooses.
void crossover(Want want, const std::vector<std::size_t>& sizes, std::size_t pairs, std::size_t runs) {
  QueryContext one({Backend::cpu, 1}), all({Backend::cpu, 0}), cuda({Backend::cuda}), automatic;
  for (const std::size_t count : sizes) {
    const CollisionModel a(benchmarks::greedyBall(count, 1)), b(benchmarks::greedyBall(count, 2));
    for (const Scene& scene : kScenes) {
      const std::vector<PairQuery> queries = sceneBatch(a, b, scene, pairs);
      std::printf("| %s | %zu | %zu | %s |", want == Want::contacts ? "contacts" : "wrench", pairs, count,
                  scene.name);
      QueryResult result;
      for (QueryContext* context : {&one, &all, &cuda, &automatic}) {
        const Times t = measure(runs, [&] {
          context->run(queries.data(), pairs, {want, Estimator::raw}, result);
        });
        std::printf(" %.1f |", t.median);
      }
      std::printf(" %s |\n", nameOf(automatic.lastBackend()));
      std::fflush(stdout);
    }
  }
}

void sweep(QueryContext& context, Backend backend, const std::string& name, std::size_t count,
           const CollisionModel& a, const CollisionModel& b, double shift) {
  constexpr int kPoses = 180;
  std::vector<double> medians;
  for (int pose = 0; pose < kPoses; ++pose) {
    const PairQuery query = queryOf(a, b, turned(2 * 3.14159265358979 * pose / kPoses, 0), {shift, 0, 0});
    medians.push_back(measure(5, [&] { context.overlap(query, {Want::wrench, Estimator::raw}); }).median);
  }
  std::sort(medians.begin(), medians.end());
  const double median = medians[kPoses / 2];
  std::printf("| %s | %s | %zu | %.0f | %.0f | %.0f | %.2f |\n", nameOf(backend), name.c_str(), count, median,
              medians[kPoses * 99 / 100], medians.back(), medians.back() / median);
  std::fflush(stdout);
}

void paper(const Packing& a, const Packing& b) {
  for (const Scene& scene : kScenes) {
    const auto [b_in_a, a_in_b] = relativePose(scene);
    const benchmarks::PaperGrid grid_a(a.spheres), grid_b(b.spheres);
    benchmarks::PaperGrid::Result from_a, from_b;
    const Times times = measure(5, [&, &b_in_a = b_in_a, &a_in_b = a_in_b] {
      from_a = grid_b.traverse(a.spheres, a_in_b, false);
      from_b = grid_a.traverse(b.spheres, b_in_a, true);
    });
    std::printf("| %s | %zu | %.0f | %zu, %zu |\n", scene.name, from_a.pairs + from_b.pairs, times.median,
                grid_a.overflows(), grid_b.overflows());
    std::fflush(stdout);
  }
}

void construction(const std::shared_ptr<const Packing>& packing, Backend backend, QueryContext& context) {
  const Times t = measure(7, [&] {
    const CollisionModel model(packing);
    PairQuery query = queryOf(model, model, turned(0, 0), {0, 0, 0});
    context.overlap(query, {Want::touch, Estimator::raw});
  });
  std::printf("| %s | %zu | %.2f | %.2f |\n", nameOf(backend), packing->spheres.size(), t.median * 1e-3,
              t.worst * 1e-3);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Time of overlap queries, as Markdown tables on stdout; microseconds as the host sees them");
  std::vector<std::size_t> counts = {4000, 15000, 60000};
  std::vector<std::string> files;
  std::size_t batch = 1024, runs = 101;
  int threads = 1;
  std::string device;
  app.add_option("--device", device, "Name of the GPU, for the head of the table");
  app.add_option("PACKING", files, "Packing files for the sweep of poses, besides the balls");
  app.add_option("--spheres", counts, "Numbers of spheres of the balls; the last is that of the other tables")
      ->capture_default_str()
      ->delimiter(',');
  app.add_option("--batch", batch, "Pairs in a batch on the GPU")->capture_default_str();
  app.add_option("--runs", runs, "Repetitions of a single query")->capture_default_str();
  app.add_option("--threads", threads, "Of the CPU backend; 0: all cores")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    std::printf("%s", benchmarks::heading("Query", argc, argv).c_str());
    if (!device.empty()) std::printf("GPU: %s\n\n", device.c_str());
    std::vector<Backend> backends = {Backend::cpu};
    if (cudaAvailable()) backends.push_back(Backend::cuda);
    const std::size_t count = counts.back();
    const auto packing_a = benchmarks::greedyBall(count, 1), packing_b = benchmarks::greedyBall(count, 2);
    const CollisionModel a(packing_a), b(packing_b);

    std::printf(
        "Two unit balls of %zu spheres, raw radii; median (99th percentile) of %zu runs, us; CPU: %d threads "
        "(0: all).\n\n"
        "| backend | overlap | pairs | touch | volume | wrench | contacts |\n"
        "|---|---|---|---|---|---|---|\n",
        count, runs, threads);
    for (Backend backend : backends) {
      QueryContext context({backend, threads});
      const bool gpu = backend == Backend::cuda;
      scenes(context, backend, a, b, gpu ? runs : std::max<std::size_t>(5, runs / 5));
    }
#ifdef INNERSPHERE_PAPER_CUDA
    if (cudaAvailable()) {
      std::printf(
          "\nThe same on the device, alone and in batches, time per pair, us. Paper: a thread a sphere, "
          "level after "
          "level, cell after cell, volume only. InnerSphere: wrench.\n\n"
          "| pairs at once | overlap | paper, kernel | paper, host | InnerSphere, kernels | InnerSphere, "
          "host "
          "(99th percentile) |\n"
          "|---|---|---|---|---|---|\n");
      devices(a, b, batch, runs);
    }
#endif
    if (cudaAvailable()) {
      std::printf(
          "\nSmall packings, us for all pairs, as the host sees it.\n\n"
          "| wanted | pairs | spheres | overlap | CPU, one thread | CPU, all threads | CUDA | automatic | on "
          "|\n"
          "|---|---|---|---|---|---|---|---|---|\n");
      const std::size_t few = std::min<std::size_t>(runs, 21);
      crossover(Want::wrench, {100, 200, 400, 800, 1600, 3200}, 1, runs);
      crossover(Want::contacts, {400, 1600, 6400, 25600}, 1, runs);
      crossover(Want::contacts, {100, 400, 1600, 6400}, 16, few);
      crossover(Want::contacts, {100, 400, 1600}, 256, few);
    }

    std::printf(
        "\nThe paper's grid (DJB2, buckets of %zu), one thread, volume only, us.\n\n"
        "| overlap | pairs found | time | overflows of A, of B |\n|---|---|---|---|\n",
        benchmarks::PaperGrid::kBucket);
    paper(*packing_a, *packing_b);

    std::printf(
        "\nA copy shifted by half the size along x and turned about z in 180 poses, us; each pose is the "
        "median "
        "of 5 runs.\n\n"
        "| backend | solid | spheres | median | 99th percentile | worst | worst over median |\n"
        "|---|---|---|---|---|---|---|\n");
    for (Backend backend : backends) {
      QueryContext context({backend, threads});
      for (std::size_t n : counts) {
        const CollisionModel one(benchmarks::greedyBall(n, 1)), other(benchmarks::greedyBall(n, 2));
        sweep(context, backend, "ball", n, one, other, 1);
      }
      for (const std::string& file : files) {
        const auto packing = std::make_shared<const Packing>(readPacking(file));
        float lo = 0, hi = 0;
        for (const Sphere& s : packing->spheres)
          lo = std::min(lo, s.x - s.radius), hi = std::max(hi, s.x + s.radius);
        const CollisionModel model(packing);
        sweep(context, backend, file.substr(file.find_last_of('/') + 1), packing->spheres.size(), model,
              model, (hi - lo) / 2.0);
      }
    }

    std::printf(
        "\nFirst query with a model, its grid built (and copied), ms.\n\n"
        "| backend | spheres | median | worst |\n|---|---|---|---|\n");
    for (Backend backend : backends) {
      QueryContext context({backend, threads});
      for (std::size_t n : counts) construction(benchmarks::greedyBall(n, 1), backend, context);
    }
    return 0;
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
