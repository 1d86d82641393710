#include "true_overlap.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace innersphere::benchmarks {
namespace {

Vec3d backIn(const Placement& copy, const Vec3d& p) {
  Vec3d q{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) q[i] += copy.rotation[3 * j + i] * (p[j] - copy.translation[j]);
  }
  return q;
}

/// The box of a moved box.
Bounds moved(const Bounds& box, const Placement& copy) {
  Bounds result{copy.translation, copy.translation};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double lo = copy.rotation[3 * i + j] * box.min[j], hi = copy.rotation[3 * i + j] * box.max[j];
      result.min[i] += std::min(lo, hi);
      result.max[i] += std::max(lo, hi);
    }
  }
  return result;
}

}  // namespace

SampledVolume sampledOverlap(const Solid& solid, const Placement& copy, std::size_t samples) {
  const Bounds own = solid.bounds(), other = moved(own, copy);
  Vec3d low, size;
  double volume = 1;
  for (int k = 0; k < 3; ++k) {
    low[k] = std::max(own.min[k], other.min[k]);
    size[k] = std::min(own.max[k], other.max[k]) - low[k];
    if (!(size[k] > 0)) return {};
    volume *= size[k];
  }
  // Multiples of the powers of the plastic number's generalisation to three dimensions, modulo 1.
  constexpr double kRoot = 1.2207440846057596;  // x^4 = x + 1
  const Vec3d step{1 / kRoot, 1 / (kRoot * kRoot), 1 / (kRoot * kRoot * kRoot)};
  const auto inside = [&](std::size_t first, std::size_t last) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(first, last, 1024), std::size_t{0},
        [&](const tbb::blocked_range<std::size_t>& range, std::size_t count) {
          for (std::size_t i = range.begin(); i < range.end(); ++i) {
            Vec3d p;
            for (int k = 0; k < 3; ++k) {
              const double x = 0.5 + step[k] * static_cast<double>(i);
              p[k] = low[k] + size[k] * (x - std::floor(x));
            }
            count += solid.contains(p) && solid.contains(backIn(copy, p));
          }
          return count;
        },
        std::plus<>());
  };
  const auto first = static_cast<double>(inside(0, samples / 2));
  const auto second = static_cast<double>(inside(samples / 2, samples / 2 * 2));
  const double both = std::max(1.0, first + second);
  return {volume * (first + second) / static_cast<double>(samples / 2 * 2),
          std::fabs(first - second) / (2 * both)};
}

}  // namespace innersphere::benchmarks
