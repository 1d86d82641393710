// How far the overlap of two packings is from the exact overlap of their solids.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

#include "exact_poses.hpp"
#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/query.hpp"
#include "machine.hpp"
#include "points_file.hpp"

namespace {

using namespace innersphere;
using namespace innersphere::benchmarks;

constexpr std::array<double, 6> kBins{0, 0.001, 0.01, 0.05, 0.15, 1};  // overlap, as a fraction of the solid

/// What is compared at one pose.
struct Deviation {
  double raw, volume_true;    ///< relative error of the volume
  double centroid;            ///< of volume-true radii, relative to the diagonal of the solid
  double angle, force_angle;  ///< [degrees] of the area vector, and of the sum of V n of the plain spheres
  double area;                ///< relative error of the length of the area vector
};

double norm(const Vec3d& a) {
  return std::hypot(a[0], a[1], a[2]);
}

double angleBetween(const Vec3d& a, const Vec3d& b) {
  const double product = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  return std::acos(std::clamp(product / (norm(a) * norm(b)), -1.0, 1.0)) * 180 / std::numbers::pi;
}

class Comparison {
 public:
  Comparison(std::shared_ptr<const Packing> packing, double diagonal)
      : model_(packing), diagonal_(diagonal), context_({Backend::cpu, 0}) {}

  Deviation at(const ExactPose& pose) {
    PairQuery query{
        &model_, &model_, placed(model_.packing(), {}), placed(model_.packing(), pose.placement), 0, 0, 0};
    const Overlap raw = context_.overlap(query, {Want::wrench, Estimator::raw});
    const Overlap full = context_.overlap(query, {Want::wrench, Estimator::volume_true});
    const Vec3d push{-pose.gradient[0], -pose.gradient[1], -pose.gradient[2]};
    Deviation d;
    d.raw = raw.volume / pose.volume - 1;
    d.volume_true = full.volume / pose.volume - 1;
    Vec3d off;
    for (int k = 0; k < 3; ++k) {
      off[k] = model_.packing().origin[k] + full.centroid[k] - pose.centroid[k];
    }
    d.centroid = full.volume > 0 ? norm(off) / diagonal_ : 1;
    d.angle = norm(full.area) > 0 ? angleBetween(full.area, push) : 180;
    d.force_angle = norm(raw.force) > 0 ? angleBetween(raw.force, push) : 180;
    d.area = norm(full.area) / norm(push) - 1;
    return d;
  }

 private:
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
double medianOf(const std::vector<Deviation>& all, const Value& value) {
  std::vector<double> values;
  for (const Deviation& d : all) values.push_back(value(d));
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void printHead() {
  std::printf(
      "| solid | spheres | overlap %% of the solid | poses | raw: mean abs. error %% | volume-true: mean "
      "abs. %% |"
      " mean signed %% | worst %% | centroid, %% of the diagonal | area vector, degrees | its length, %% |"
      " raw sum V n, degrees |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void printRow(const std::string& name, std::uint32_t count, int bin, const std::vector<Deviation>& all) {
  const auto volume_true = [](const Deviation& d) { return std::abs(d.volume_true); };
  double worst = 0;
  for (const Deviation& d : all) worst = std::max(worst, volume_true(d));
  std::printf("| %s | %u | %g-%g | %zu | %.1f | %.2f | %+.2f | %.1f | %.3f | %.2f | %.1f | %.1f |\n",
              name.c_str(), count, 100 * kBins[bin], 100 * kBins[bin + 1], all.size(),
              100 * meanOf(all, [](const Deviation& d) { return std::abs(d.raw); }),
              100 * meanOf(all, volume_true),
              100 * meanOf(all, [](const Deviation& d) { return d.volume_true; }), 100 * worst,
              100 * medianOf(all, [](const Deviation& d) { return d.centroid; }),
              medianOf(all, [](const Deviation& d) { return d.angle; }),
              100 * medianOf(all, [](const Deviation& d) { return std::abs(d.area); }),
              medianOf(all, [](const Deviation& d) { return d.force_angle; }));
}

using Bins = std::array<std::vector<Deviation>, kBins.size() - 1>;

void printRows(const std::string& name, std::uint32_t count, const Bins& bins) {
  for (int bin = 0; bin < static_cast<int>(bins.size()); ++bin) {
    if (!bins[bin].empty()) printRow(name, count, bin, bins[bin]);
  }
  std::fflush(stdout);
}

void compare(const std::string& mesh, const std::string& table, const std::vector<std::size_t>& counts,
             FILE* points, std::map<std::uint32_t, Bins>& all) {
  const std::vector<ExactPose> poses = readOverlappingPoses(table);
  const auto solid = makeSolid(readMesh(mesh), mesh);
  const Bounds box = solid->bounds();
  const double diagonal = norm({box.max[0] - box.min[0], box.max[1] - box.min[1], box.max[2] - box.min[2]});
  const std::string name = mesh.substr(mesh.find_last_of('/') + 1);
  for (const std::size_t spheres : counts) {
    PackOptions options;
    options.spheres = spheres;
    const auto packing = std::make_shared<const Packing>(pack(*solid, options));
    Comparison comparison(packing, diagonal);
    const auto count = static_cast<std::uint32_t>(packing->spheres.size());
    Bins bins;
    for (const ExactPose& pose : poses) {
      const double fraction = pose.volume / packing->solid.volume;
      int bin = 0;
      while (bin + 2 < static_cast<int>(kBins.size()) && fraction >= kBins[bin + 1]) ++bin;
      bins[bin].push_back(comparison.at(pose));
      if (points) {
        std::fprintf(points, "%s %u %g %g %g\n", name.c_str(), count, fraction, bins[bin].back().raw,
                     bins[bin].back().volume_true);
      }
    }
    printRows(name, count, bins);
    for (std::size_t bin = 0; bin < bins.size(); ++bin) {
      std::vector<Deviation>& so_far = all[count][bin];
      so_far.insert(so_far.end(), bins[bin].begin(), bins[bin].end());
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Error of overlap volumes against exact ones, as a Markdown table on stdout");
  std::vector<std::string> cases;
  std::vector<std::size_t> counts{1000, 4000, 16000};
  app.add_option("MESH=POSES", cases,
                 "A mesh, and a table of poses of its copy with the exact overlaps (CSV)")
      ->required();
  app.add_option("--spheres", counts, "Numbers of spheres")->capture_default_str()->delimiter(',');
  std::string points_path;
  app.add_option("--points", points_path,
                 "Write solid, spheres, overlap, errors raw and volume-true there, for plots");
  CLI11_PARSE(app, argc, argv);
  const innersphere::benchmarks::PointsFile points(points_path);
  if (!points.good()) return 1;
  try {
    std::printf("%s", innersphere::benchmarks::heading("Accuracy of the overlap", argc, argv).c_str());
    printHead();
    std::map<std::uint32_t, Bins> all;
    for (const std::string& item : cases) {
      const std::size_t equals = item.find('=');
      if (equals == std::string::npos) {
        std::fprintf(stderr, "%s: give a mesh and a table as MESH=POSES\n", item.c_str());
        return 2;
      }
      compare(item.substr(0, equals), item.substr(equals + 1), counts, points.get(), all);
    }
    for (const auto& [count, bins] : all) printRows("all", count, bins);
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
