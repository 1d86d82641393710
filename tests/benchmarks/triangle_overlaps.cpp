// How exact and how fast overlaps by triangles are, beside those by spheres.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "exact_poses.hpp"
#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/query.hpp"
#include "machine.hpp"

namespace {

using namespace innersphere;
using namespace innersphere::benchmarks;

constexpr std::array<double, 6> kBins{0, 0.001, 0.01, 0.05, 0.15, 1};  // overlap, as a fraction of the solid

/// What is compared at one pose.
struct Deviation {
  double spheres, surface;              ///< relative errors of the volume
  double spheres_angle, surface_angle;  ///< of the area vector [degrees]
  double centroid;                      ///< of the triangles', relative to the diagonal of the solid
  double spheres_time, surface_time;    ///< [s]
};

double angleBetween(const Vec3d& a, const Vec3d& b) {
  if (!(norm(a) > 0)) return 180;
  return std::acos(std::clamp(dot(a, b) / (norm(a) * norm(b)), -1.0, 1.0)) * 180 / std::numbers::pi;
}

class Comparison {
 public:
  Comparison(std::shared_ptr<const Packing> packing, double diagonal)
      : model_(packing), diagonal_(diagonal), context_({Backend::cpu, 1}) {}

  Deviation at(const ExactPose& pose) {
    const PairQuery query{
        &model_, &model_, placed(model_.packing(), {}), placed(model_.packing(), pose.placement), 0, 0, 0};
    Overlap spheres, surface;
    const double seconds = timed(query, Estimator::volume_true, spheres);
    const double seconds_surface = timed(query, Estimator::surface, surface);
    const Vec3d push = -pose.gradient;
    Deviation d;
    d.spheres = spheres.volume / pose.volume - 1;
    d.surface = surface.volume / pose.volume - 1;
    d.spheres_angle = angleBetween(spheres.area, push);
    d.surface_angle = angleBetween(surface.area, push);
    const Vec3d origin = placed(model_.packing(), {}).translation;
    d.centroid = norm(origin + surface.centroid - pose.centroid) / diagonal_;
    d.spheres_time = seconds;
    d.surface_time = seconds_surface;
    return d;
  }

 private:
  /// The shortest of a few runs [s].
  double timed(const PairQuery& query, Estimator estimator, Overlap& overlap) {
    double best = 1e300;
    for (int run = 0; run < 5; ++run) {
      const auto start = std::chrono::steady_clock::now();
      overlap = context_.overlap(query, {Want::wrench, estimator});
      best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return best;
  }

  CollisionModel model_;
  double diagonal_;
  QueryContext context_;
};

template <class Value>
double meanOf(const std::vector<Deviation>& all, const Value& value) {
  double sum = 0;
  for (const Deviation& d : all) sum += value(d);
  return sum / static_cast<double>(all.size());
}

template <class Value>
double worstOf(const std::vector<Deviation>& all, const Value& value) {
  double worst = 0;
  for (const Deviation& d : all) worst = std::max(worst, value(d));
  return worst;
}

template <class Value>
double medianOf(const std::vector<Deviation>& all, const Value& value) {
  std::vector<double> values;
  for (const Deviation& d : all) values.push_back(value(d));
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void printRow(const std::string& name, std::size_t bin, const std::vector<Deviation>& all) {
  const auto surface = [](const Deviation& d) { return std::abs(d.surface); };
  std::printf("| %s | %g-%g | %zu | %.2f | %.2g | %.2g | %.1f | %.2g | %.1g | %.1f | %.1f |\n", name.c_str(),
              100 * kBins[bin], 100 * kBins[bin + 1], all.size(),
              100 * meanOf(all, [](const Deviation& d) { return std::abs(d.spheres); }),
              100 * meanOf(all, surface), 100 * worstOf(all, surface),
              medianOf(all, [](const Deviation& d) { return d.spheres_angle; }),
              medianOf(all, [](const Deviation& d) { return d.surface_angle; }),
              100 * medianOf(all, [](const Deviation& d) { return d.centroid; }),
              1e6 * medianOf(all, [](const Deviation& d) { return d.spheres_time; }),
              1e6 * medianOf(all, [](const Deviation& d) { return d.surface_time; }));
}

void compare(const std::string& mesh, const std::string& table, std::size_t spheres) {
  const auto solid = makeSolid(readMesh(mesh), mesh);
  const Bounds box = solid->bounds();
  PackOptions options;
  options.spheres = spheres;
  const auto packing = std::make_shared<const Packing>(pack(*solid, options));
  Comparison comparison(packing, norm(box.max - box.min));
  std::array<std::vector<Deviation>, kBins.size() - 1> bins;
  for (const ExactPose& pose : readOverlappingPoses(table)) {
    const double fraction = pose.volume / packing->solid.volume;
    std::size_t bin = 0;
    while (bin + 2 < kBins.size() && fraction >= kBins[bin + 1]) ++bin;
    bins[bin].push_back(comparison.at(pose));
  }
  const std::string name = mesh.substr(mesh.find_last_of('/') + 1);
  for (std::size_t bin = 0; bin < bins.size(); ++bin) {
    if (!bins[bin].empty()) printRow(name, bin, bins[bin]);
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Errors of overlap volumes by spheres and by triangles, as a Markdown table on stdout");
  std::vector<std::string> cases;
  std::size_t spheres = 4000;
  app.add_option("MESH=POSES", cases, "A mesh, and a table of exact overlaps (see exact_overlaps.py)")
      ->required();
  app.add_option("--spheres", spheres, "Number of spheres")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    std::printf("%s", heading("Overlaps by triangles", argc, argv).c_str());
    std::printf(
        "| solid | overlap %% of the solid | poses | spheres: mean error %% | triangles: mean error %% | "
        "worst %% | spheres: force, degrees | triangles: degrees | triangles: centroid, %% of the diagonal | "
        "spheres: us | triangles: us |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const std::string& item : cases) {
      const std::size_t equals = item.find('=');
      if (equals == std::string::npos) {
        std::fprintf(stderr, "%s: give a mesh and a table as MESH=POSES\n", item.c_str());
        return 2;
      }
      compare(item.substr(0, equals), item.substr(equals + 1), spheres);
    }
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
