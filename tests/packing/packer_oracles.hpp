// What the packer's results are compared with, written without its code.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "innersphere/packing.hpp"
#include "innersphere/solid.hpp"

namespace innersphere::test {

using Real = long double;

inline Real distance(const Sphere& a, const Sphere& b) {
  return std::hypot(Real{a.x} - b.x, Real{a.y} - b.y, Real{a.z} - b.z);
}

/// Every pair, without any structure.
inline Real worstOverlap(const Packing& packing) {
  Real worst = -1e30L;
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Sphere &a = packing.spheres[i], &b = packing.spheres[j];
      worst = std::max(worst, Real{a.radius} + b.radius - distance(a, b));
    }
  }
  return worst;
}

/// The largest sphere about x: 0 outside the solid and inside one of the first `count` spheres.
inline double room(const Solid& solid, const Packing& packing, std::size_t count, const Vec3d& x) {
  if (!solid.contains(x)) return 0;
  double least = solid.closestPoint(x).distance;
  for (std::size_t i = 0; i < count && least > 0; ++i) {
    const Sphere& s = packing.spheres[i];
    least = std::min(least, std::hypot(x[0] - s.x, x[1] - s.y, x[2] - s.z) - s.radius);
  }
  return std::max(0.0, least);
}

/// The largest sphere that a random search finds beside the first `count` spheres: many points, and from the
/// best of them random steps upwards.
inline double largestRoom(const Solid& solid, const Packing& packing, std::size_t count, int points) {
  std::mt19937_64 random(1);
  const Bounds box = solid.bounds();
  std::uniform_real_distribution<double> unit(0, 1);
  double best = 0;
  for (int climb = 0; climb < 20; ++climb) {
    Vec3d at{};
    double most = 0;
    for (int i = 0; i < points / 20; ++i) {
      Vec3d x;
      for (int k = 0; k < 3; ++k) x[k] = box.min[k] + unit(random) * (box.max[k] - box.min[k]);
      const double now = room(solid, packing, count, x);
      if (now > most) {
        most = now;
        at = x;
      }
    }
    for (double step = most; step > 1e-4 * most; step *= 0.97) {
      Vec3d x = at;
      for (double& c : x) c += step * (2 * unit(random) - 1);
      const double now = room(solid, packing, count, x);
      if (now > most) {
        most = now;
        at = x;
      }
    }
    best = std::max(best, most);
  }
  return best;
}

/// The volume that two balls share, in closed form.
inline Real lens(Real r1, Real r2, Real d) {
  const Real pi = std::numbers::pi_v<Real>;
  if (d >= r1 + r2) return 0;
  if (d <= std::abs(r1 - r2)) return 4 * pi / 3 * std::pow(std::min(r1, r2), 3.0L);
  const Real s = r1 + r2 - d;
  return pi * s * s * (d * d + 2 * d * (r1 + r2) - 3 * (r1 - r2) * (r1 - r2)) / (12 * d);
}

inline bool sameErrors(const std::vector<OverlapErrors::AtDepth>& a,
                       const std::vector<OverlapErrors::AtDepth>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const OverlapErrors::AtDepth& one, const OverlapErrors::AtDepth& other) {
                      return one.depth == other.depth && one.error.mean == other.error.mean &&
                             one.error.bound == other.error.bound && one.volume == other.volume &&
                             one.power == other.power;
                    });
}

inline bool sameEstimate(const OverlapErrors::Estimate& a, const OverlapErrors::Estimate& b) {
  return sameErrors(a.copies, b.copies) && sameErrors(a.deep, b.deep) && a.thickest == b.thickest &&
         sameErrors(a.planes, b.planes) && sameErrors(a.inside, b.inside);
}

inline bool sameBytes(const Packing& a, const Packing& b) {
  if (a.spheres.size() != b.spheres.size() || a.volume_true.size() != b.volume_true.size()) return false;
  for (std::size_t i = 0; i < a.spheres.size(); ++i) {
    const Sphere &s = a.spheres[i], &t = b.spheres[i];
    if (s.x != t.x || s.y != t.y || s.z != t.z || s.radius != t.radius) return false;
  }
  for (std::size_t i = 0; i < a.volume_true.size(); ++i) {
    if (a.volume_true[i].radii != b.volume_true[i].radii) return false;
    if (a.volume_true[i].sampling_error != b.volume_true[i].sampling_error) return false;
  }
  if (a.mass_weights != b.mass_weights || a.overlap_errors.poses != b.overlap_errors.poses ||
      a.overlap_errors.sampling_error != b.overlap_errors.sampling_error ||
      a.overlap_errors.prefixes.size() != b.overlap_errors.prefixes.size()) {
    return false;
  }
  for (std::size_t i = 0; i < a.overlap_errors.prefixes.size(); ++i) {
    const OverlapErrors::Prefix &p = a.overlap_errors.prefixes[i], &q = b.overlap_errors.prefixes[i];
    if (!sameEstimate(p.raw, q.raw) || !sameEstimate(p.volume_true, q.volume_true)) return false;
  }
  return a.certificate.delta == b.certificate.delta &&
         a.certificate.largest_missing_radius == b.certificate.largest_missing_radius &&
         a.quality.density == b.quality.density && a.quality.gap_mean == b.quality.gap_mean &&
         a.quality.gap_max == b.quality.gap_max;
}

}  // namespace innersphere::test
