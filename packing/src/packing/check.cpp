#include "innersphere/check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace innersphere {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool finite(const Sphere& s) {
  return std::isfinite(s.x) && std::isfinite(s.y) && std::isfinite(s.z) && std::isfinite(s.radius);
}

double overlap(const Sphere& a, const Sphere& b) {
  const double x = double{a.x} - b.x, y = double{a.y} - b.y, z = double{a.z} - b.z;
  return double{a.radius} + b.radius - std::sqrt(x * x + y * y + z * z);
}

// Sweep along x. A pair cannot overlap by more than its intervals on the x axis do, so a sphere's partners
// end where the worst overlap so far is out of reach.
void findWorstOverlap(const std::vector<Sphere>& spheres, CheckReport& report) {
  const auto first = [&](std::size_t i) { return double{spheres[i].x} - spheres[i].radius; };
  const auto last = [&](std::size_t i) { return double{spheres[i].x} + spheres[i].radius; };
  std::vector<std::size_t> order(spheres.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return first(i) < first(j); });
  double worst = -kInfinity;
  for (std::size_t a = 0; a + 1 < order.size(); ++a) {
    const std::size_t i = order[a];
    for (std::size_t b = a + 1; b < order.size() && last(i) - first(order[b]) > worst; ++b) {
      const std::size_t j = order[b];
      const double now = overlap(spheres[i], spheres[j]);
      if (now > worst) {
        worst = now;
        report.overlap_i = std::min(i, j);
        report.overlap_j = std::max(i, j);
      }
    }
  }
  if (spheres.size() > 1) report.worst_overlap = worst;
}

void findWorstProtrusion(const Packing& packing, const Solid& solid, CheckReport& report) {
  const std::vector<Sphere>& spheres = packing.spheres;
  const Vec3d& o = packing.origin;
  report.worst_protrusion = spheres.empty() ? 0 : -kInfinity;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Vec3d centre{o[0] + spheres[i].x, o[1] + spheres[i].y, o[2] + spheres[i].z};
    const double distance = solid.closestPoint(centre).distance;
    const double protrusion = spheres[i].radius + (solid.contains(centre) ? -distance : distance);
    if (!(protrusion <= report.worst_protrusion)) {
      report.worst_protrusion = protrusion;
      report.protruding = i;
    }
  }
}

}  // namespace

CheckReport check(const Packing& packing, const Solid* solid) {
  CheckReport report;
  const std::vector<Sphere>& spheres = packing.spheres;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    if (!finite(spheres[i])) {
      report.worst_overlap = report.worst_protrusion = kInfinity;
      report.overlap_i = report.overlap_j = report.protruding = i;
      report.sorted = false;
      return report;
    }
    if (packing.order == SphereOrder::radius && i > 0 && spheres[i].radius > spheres[i - 1].radius) report.sorted = false;
  }
  findWorstOverlap(spheres, report);
  if (solid) findWorstProtrusion(packing, *solid, report);

  const double volume = solid ? solid->massProperties().volume : packing.solid.volume;
  if (volume > 0) {
    double filled = 0;
    for (const Sphere& s : spheres) filled += 4.0 / 3.0 * std::numbers::pi * std::pow(double{s.radius}, 3);
    report.density = filled / volume;
  }
  return report;
}

}  // namespace innersphere
