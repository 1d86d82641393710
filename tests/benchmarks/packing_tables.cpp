#include "packing_tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "innersphere/check.hpp"
#include "innersphere/error.hpp"
#include "machine.hpp"
#include "measured_pack.hpp"
#include "moved_solid.hpp"

namespace innersphere::benchmarks {
namespace {

MeasuredPack packed(const Solid& solid, std::size_t spheres, int threads = 0) {
  PackOptions options;
  options.spheres = spheres;
  options.threads = threads;
  return measuredPack(solid, options);
}

void row(const std::string& name, const MeasuredPack& m, const Solid& solid) {
  const auto n = static_cast<double>(m.packing.spheres.size());
  std::printf("| %s | %.0f | %.2f | %.2f | %.2f | %.2f | %.0f | %.0f | %s |\n", name.c_str(), n,
              100 * m.packing.quality.density, m.seconds, m.cpu_seconds, m.placing, n / m.seconds,
              peakMemory(), check(m.packing, &solid).valid() ? "valid" : "**invalid**");
  std::fflush(stdout);
}

void head(const char* title) {
  std::printf(
      "\n## %s\n\n| solid | spheres | density %% | time s | CPU s | time until placed s | spheres/s |"
      " peak memory so far MiB | checker |\n|---|---|---|---|---|---|---|---|---|\n",
      title);
}

bool sameBytes(const Packing& a, const Packing& b) {
  const auto same = [](const Sphere& s, const Sphere& t) {
    return s.x == t.x && s.y == t.y && s.z == t.z && s.radius == t.radius;
  };
  return std::equal(a.spheres.begin(), a.spheres.end(), b.spheres.begin(), b.spheres.end(), same) &&
         std::equal(a.volume_true.begin(), a.volume_true.end(), b.volume_true.begin(), b.volume_true.end(),
                    [](const auto& s, const auto& t) { return s.radii == t.radii; }) &&
         a.mass_weights == b.mass_weights && a.quality.gap_mean == b.quality.gap_mean &&
         a.certificate.largest_missing_radius == b.certificate.largest_missing_radius;
}

/// The largest difference of radii of the same number, relative to the largest radius.
double radiusDifference(const Packing& a, const Packing& b, double scale) {
  double worst = 0;
  for (std::size_t i = 0; i < std::min(a.spheres.size(), b.spheres.size()); ++i) {
    worst = std::max(worst, std::abs(a.spheres[i].radius - b.spheres[i].radius / scale));
  }
  return worst / a.spheres.front().radius;
}

}  // namespace

void tableOfDensities(const std::vector<Case>& cases, const std::vector<std::size_t>& counts,
                      Curves& curves) {
  head("Density");
  for (const Case& solid : cases) {
    for (std::size_t count : counts) {
      const MeasuredPack m = packed(*solid.solid, count);
      row(solid.name, m, *solid.solid);
      curves[solid.name].emplace_back(m.packing.spheres.size(), m.packing.quality.density);
    }
  }
}

void tableOfLinearity(const Case& solid, std::size_t most) {
  head("Many spheres");
  for (std::size_t count = most / 16; count <= most; count *= 2) {
    row(solid.name, packed(*solid.solid, count), *solid.solid);
  }
}

void tableOfInvariance(const Case& solid) {
  constexpr std::size_t kSpheres = 10000;
  std::printf(
      "\n## Threads, scale and place (%s, %zu spheres)\n\n| | spheres | density %% | same bytes | largest "
      "difference "
      "of "
      "radii, relative to the largest radius | checker |\n|---|---|---|---|---|---|\n",
      solid.name.c_str(), kSpheres);
  const Packing reference = packed(*solid.solid, kSpheres, 1).packing;
  const auto compare = [&](const std::string& name, const Solid& moved, int threads, double scale) {
    Packing other;
    try {
      other = packed(moved, kSpheres, threads).packing;
    } catch (const Error& error) {
      std::printf("| %s | - | - | - | - | refused: %s |\n", name.c_str(), toString(error.code()));
      return;
    }
    std::printf("| %s | %zu | %.3f | %s | %.1e | %s |\n", name.c_str(), other.spheres.size(),
                100 * other.quality.density, sameBytes(reference, other) ? "yes" : "no",
                radiusDifference(reference, other, scale),
                check(other, &moved).valid() ? "valid" : "**invalid**");
    std::fflush(stdout);
  };
  compare("1 thread, again", *solid.solid, 1, 1);
  for (int threads : {2, 8}) compare(std::to_string(threads) + " threads", *solid.solid, threads, 1);
  for (double scale : {1e-3, 1e3}) {
    char name[40];
    std::snprintf(name, sizeof name, "scaled by %g", scale);
    compare(name, MovedSolid(solid.solid, scale, {}), 0, scale);
  }
  const Bounds box = solid.solid->bounds();
  const double size = std::max({box.max[0] - box.min[0], box.max[1] - box.min[1], box.max[2] - box.min[2]});
  for (double sizes : {1e3, 1e4, 1e5, 1e6}) {
    char name[40];
    std::snprintf(name, sizeof name, "moved by %g of its sizes", sizes);
    compare(name, MovedSolid(solid.solid, 1, {sizes * size, 0, 0}), 0, 1);
  }
}

void tableOfSlowCases() {
  head("Hard to pack");
  for (const auto& [name, mesh] : hardMeshes()) {
    const auto solid = makeSolid(mesh, name);
    row(name, packed(*solid, 10000), *solid);
  }
}

void writeCurves(const Curves& curves, const std::string& path) {
  std::ofstream file(path);
  for (const auto& [name, points] : curves) {
    file << "# " << name << '\n';
    for (const auto& [spheres, density] : points) file << spheres << ' ' << 100 * (1 - density) << '\n';
    file << "\n\n";
  }
}

}  // namespace innersphere::benchmarks
