// How many spheres cover a point, on average, by its depth below the surface: what shallow overlaps see.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>

#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/solids.hpp"
#include "machine.hpp"

namespace {

using namespace innersphere;

/// Points of a triangle surface, equally dense everywhere, with the way inwards.
class SurfacePoints {
 public:
  explicit SurfacePoints(const Surface& surface) : surface_(surface) {
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      const Vec3d n = normal(t);
      area_.push_back((area_.empty() ? 0 : area_.back()) + std::hypot(n[0], n[1], n[2]));
    }
  }

  struct Point {
    Vec3d at, inwards;
  };

  Point pick(std::mt19937_64& random) const {
    std::uniform_real_distribution<double> unit(0, 1);
    const double target = unit(random) * area_.back();
    const auto t =
        static_cast<std::size_t>(std::lower_bound(area_.begin(), area_.end(), target) - area_.begin());
    double u = unit(random), v = unit(random);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const Vec3d n = normal(t);
    const double length = std::hypot(n[0], n[1], n[2]);
    Point point;
    for (int k = 0; k < 3; ++k) {
      point.at[k] = (1 - u - v) * corner(t, 0, k) + u * corner(t, 1, k) + v * corner(t, 2, k);
      point.inwards[k] = -n[k] / length;
    }
    return point;
  }

 private:
  double corner(std::size_t t, int c, int k) const { return surface_.vertices[surface_.triangles[t][c]][k]; }
  Vec3d normal(std::size_t t) const {
    Vec3d a, b;
    for (int k = 0; k < 3; ++k) {
      a[k] = corner(t, 1, k) - corner(t, 0, k);
      b[k] = corner(t, 2, k) - corner(t, 0, k);
    }
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }

  const Surface& surface_;
  std::vector<double> area_;  // up to and with each triangle, twice
};

void profile(const std::string& name, const Packing& packing, const VolumeTrueRadii& radii) {
  constexpr int kPoints = 4000, kSteps = 20, kOutside = 2;
  const double unit = packing.spheres[radii.count - 1].radius, step = 0.25 * unit;
  std::vector<double> plain(kSteps), volume_true(kSteps);
  std::mt19937_64 random(1);
  const SurfacePoints points(packing.surface);
  for (int i = 0; i < kPoints; ++i) {
    const SurfacePoints::Point point = points.pick(random);
    for (std::uint32_t s = 0; s < radii.count; ++s) {
      const Sphere& ball = packing.spheres[s];
      const Vec3d way{point.at[0] - ball.x, point.at[1] - ball.y, point.at[2] - ball.z};
      const double squared = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
      const double reach = radii.radii[s] + kSteps * step;
      if (squared > reach * reach) continue;
      const double along = way[0] * point.inwards[0] + way[1] * point.inwards[1] + way[2] * point.inwards[2];
      for (int k = 0; k < kSteps; ++k) {
        const double depth = (k - kOutside + 0.5) * step;
        const double apart = squared + depth * (depth + 2 * along);
        plain[k] += apart < double{ball.radius} * ball.radius;
        volume_true[k] += apart < double{radii.radii[s]} * radii.radii[s];
      }
    }
  }
  double missing = 0;
  for (int k = 0; k < kSteps; ++k) {
    const double depth = (k - kOutside + 0.5) * 0.25;
    missing += 0.25 * ((depth > 0 ? 1 : 0) - volume_true[k] / kPoints);
    std::printf("| %s | %u | %.3f | %.2f | %.2f | %.2f |\n", name.c_str(), radii.count, depth,
                plain[k] / kPoints, volume_true[k] / kPoints, missing);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Mean coverage by the spheres of a packing, by depth below the surface");
  std::vector<std::string> sources{"box"};
  std::size_t spheres = 4096;
  app.add_option("SOLID", sources, "Mesh files or names of solids")->capture_default_str();
  app.add_option("--spheres", spheres, "Of each packing")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    std::printf("%s", benchmarks::heading("Coverage below the surface", argc, argv).c_str());
    std::printf(
        "| solid | spheres | depth, smallest radii | plain | volume-true | missing down to there, smallest "
        "radii "
        "|\n|---|---|---|---|---|---|\n");
    for (const std::string& source : sources) {
      const bool is_mesh = std::filesystem::exists(source);
      const auto solid = is_mesh ? makeSolid(readMesh(source), source) : makeNamedSolid(source);
      PackOptions options;
      options.spheres = spheres;
      const Packing packing = pack(*solid, options);
      profile(std::filesystem::path(source).stem().string(), packing, packing.volume_true.back());
    }
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
