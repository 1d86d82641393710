// How far the tables that `innersphere overlap` writes are from exact overlaps.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "csv_table.hpp"
#include "exact_poses.hpp"
#include "innersphere/error.hpp"
#include "machine.hpp"
#include "source.hpp"
#include "timing.hpp"

namespace {

using namespace innersphere;
using namespace innersphere::benchmarks;

constexpr std::array<double, 5> kOverlapBins{0, 0.01, 0.05, 0.15, 1};  // fractions of the solid
constexpr std::size_t kDepths = kOverlapBins.size() - 1;

/// Deviations of poses that are equally deep.
struct Bin {
  std::vector<double> volume, centroid, angle;  ///< relative, relative to the diagonal, degrees
};

double norm(const Vec3d& a) {
  return std::hypot(a[0], a[1], a[2]);
}

double angleBetween(const Vec3d& a, const Vec3d& b) {
  const double product = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  return std::acos(std::clamp(product / (norm(a) * norm(b)), -1.0, 1.0)) * 180 / std::numbers::pi;
}

std::array<Bin, kDepths> compare(const CsvTable& found, const std::vector<ExactPose>& exact,
                                 const Solid& solid) {
  if (found.rows() != exact.size())
    throw Error(ErrorCode::bad_format, "the two tables have different numbers of poses");
  const Bounds box = solid.bounds();
  const double diagonal = norm({box.max[0] - box.min[0], box.max[1] - box.min[1], box.max[2] - box.min[2]});
  const double volume = solid.massProperties().volume;
  std::array<Bin, kDepths> bins;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const ExactPose& truth = exact[i];
    if (!(truth.volume > 0)) continue;
    std::size_t depth = 0;
    while (depth + 1 < kDepths && truth.volume >= kOverlapBins[depth + 1] * volume) ++depth;
    const auto vector = [&](const char* x, const char* y, const char* z) {
      return Vec3d{found.number(i, x), found.number(i, y), found.number(i, z)};
    };
    const Vec3d c = vector("cx", "cy", "cz"), force = vector("fx", "fy", "fz"), &t = truth.centroid;
    const Vec3d push{-truth.gradient[0], -truth.gradient[1], -truth.gradient[2]};
    bins[depth].volume.push_back(std::fabs(found.number(i, "volume") / truth.volume - 1));
    bins[depth].centroid.push_back(norm({c[0] - t[0], c[1] - t[1], c[2] - t[2]}) / diagonal);
    bins[depth].angle.push_back(norm(force) > 0 ? angleBetween(force, push) : 180);
  }
  return bins;
}

void print(const std::string& name, const std::string& spheres, const std::array<Bin, kDepths>& bins) {
  std::printf("| %s | %s |", name.c_str(), spheres.c_str());
  for (const Bin& bin : bins) {
    if (bin.volume.empty()) {
      std::printf(" - |");
      continue;
    }
    double sum = 0;
    for (const double x : bin.volume) sum += x;
    std::printf(" %.2f / %.3f / %.1f |", 100 * sum / static_cast<double>(bin.volume.size()),
                100 * median(bin.centroid), median(bin.angle));
  }
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Error of the tables that `innersphere overlap MESH MESH --poses POSES -o TABLE` writes: a row of a "
      "Markdown "
      "table for each.");
  std::vector<std::string> items;
  app.add_option("MESH=POSES=SPHERES=TABLE", items,
                 "The mesh, its poses with the exact overlaps (CSV), the number of spheres and the table")
      ->required();
  CLI11_PARSE(app, argc, argv);
  try {
    std::printf("%s", heading("Overlap tables of the tool", argc, argv).c_str());
    std::printf(
        "By depth of the overlap, %% of the solid: mean absolute error of the volume, %% / centroid, %% of "
        "the "
        "diagonal / direction of the force against the exact gradient, degrees; medians.\n\n| solid | "
        "spheres |");
    for (std::size_t depth = 0; depth < kDepths; ++depth)
      std::printf(" %g-%g |", 100 * kOverlapBins[depth], 100 * kOverlapBins[depth + 1]);
    std::printf("\n|---|---|---|---|---|---|\n");
    for (const std::string& item : items) {
      const std::vector<std::string> parts = CLI::detail::split(item, '=');
      if (parts.size() != 4) throw Error(ErrorCode::bad_argument, item + ": give MESH=POSES=SPHERES=TABLE");
      print(plainName(parts[0]), parts[2],
            compare(CsvTable(parts[3]), readExactPoses(parts[1]), *solidFrom(parts[0])));
    }
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
