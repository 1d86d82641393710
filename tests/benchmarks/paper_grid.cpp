#include "paper_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace innersphere::benchmarks {
namespace {

constexpr double kPi = 3.14159265358979323846;

int exponentOf(float radius) {
  int e;
  const float fraction = std::frexp(2 * radius, &e);  // 2 r = fraction 2^e, fraction from 1/2 to 1
  return fraction == 0.5f ? e - 1 : e;
}

std::array<int, 3> cellOf(const std::array<float, 3>& p, float by, double inverse_cell) {
  return {static_cast<int>(std::floor((p[0] + by) * inverse_cell)),
          static_cast<int>(std::floor((p[1] + by) * inverse_cell)),
          static_cast<int>(std::floor((p[2] + by) * inverse_cell))};
}

/// Calls f for each cell from lo to hi.
template <typename F>
void forCells(const std::array<int, 3>& lo, const std::array<int, 3>& hi, const F& f) {
  for (int x = lo[0]; x <= hi[0]; ++x) {
    for (int y = lo[1]; y <= hi[1]; ++y) {
      for (int z = lo[2]; z <= hi[2]; ++z) f(std::array<int, 3>{x, y, z});
    }
  }
}

}  // namespace

PaperGrid::PaperGrid(const std::vector<Sphere>& spheres)
    : spheres_(spheres), buckets_(std::bit_ceil(4 * spheres.size())) {
  finest_ = exponentOf(spheres.back().radius);
  coarsest_ = exponentOf(spheres.front().radius);
  for (std::uint32_t i = 0; i < spheres.size(); ++i) {
    const Sphere& s = spheres[i];
    const int level = exponentOf(s.radius);
    const double inverse = std::ldexp(1.0, -level);
    forCells(cellOf({s.x, s.y, s.z}, -s.radius, inverse), cellOf({s.x, s.y, s.z}, s.radius, inverse),
             [&](const std::array<int, 3>& cell) {
               auto& full = const_cast<Bucket&>(bucket(level, cell));
               if (full.count < kBucket) {
                 full.spheres[full.count++] = i;
               } else {
                 ++overflows_;
               }
             });
  }
}

const PaperGrid::Bucket& PaperGrid::bucket(int level, const std::array<int, 3>& cell) const {
  std::uint32_t hash = 5381;  // DJB2
  for (int x : {level, cell[0], cell[1], cell[2]}) hash = hash * 33 + static_cast<std::uint32_t>(x);
  return buckets_[hash & (buckets_.size() - 1)];
}

PaperGrid::Result PaperGrid::traverse(const std::vector<Sphere>& query_spheres, const Placement& placement,
                                      bool strictly) const {
  Result result;
  const Mat3d& m = placement.rotation;
  const Vec3d& t = placement.translation;
  for (const Sphere& w : query_spheres) {
    std::array<float, 3> p;
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = static_cast<float>(m[3 * k] * w.x + m[3 * k + 1] * w.y + m[3 * k + 2] * w.z + t[k]);
    for (int level = std::max(exponentOf(w.radius), finest_); level <= coarsest_; ++level) {
      const double inverse = std::ldexp(1.0, -level);
      const std::array<int, 3> lo = cellOf(p, -w.radius, inverse);
      forCells(lo, cellOf(p, w.radius, inverse), [&](const std::array<int, 3>& cell) {
        const Bucket& found = bucket(level, cell);
        for (std::uint32_t k = 0; k < found.count; ++k) {
          const Sphere& s = spheres_[found.spheres[k]];
          if (strictly ? !(s.radius > w.radius) : !(s.radius >= w.radius)) continue;
          const double dx = p[0] - s.x, dy = p[1] - s.y, dz = p[2] - s.z;
          const double d2 = dx * dx + dy * dy + dz * dz, sum = double{s.radius} + w.radius;
          if (!(d2 < sum * sum) || exponentOf(s.radius) != level) continue;
          // A pair counts in the first cell that both are in; a bucket may also hold spheres of other cells.
          const std::array<int, 3> first = cellOf({s.x, s.y, s.z}, -s.radius, inverse);
          bool counts = true;
          for (std::size_t axis = 0; axis < 3; ++axis)
            counts = counts && cell[axis] == std::max(lo[axis], first[axis]);
          if (!counts) continue;
          ++result.pairs;
          const double d = std::sqrt(d2), step = double{s.radius} - w.radius, depth = sum - d;
          result.volume += d <= std::fabs(step)
                               ? 4 * kPi / 3 * std::pow(std::min(s.radius, w.radius), 3)
                               : kPi * depth * depth * (d2 + 2 * d * sum - 3 * step * step) / (12 * d);
        }
      });
    }
  }
  return result;
}

}  // namespace innersphere::benchmarks
