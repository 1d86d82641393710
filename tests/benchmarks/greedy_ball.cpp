#include "greedy_ball.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace innersphere::benchmarks {
namespace {

using Point = std::array<double, 3>;

/// Cells that list every sphere within one cell's edge of them: clearances up to an edge are exact.
class Cells {
 public:
  explicit Cells(double edge) : edge_(edge), side_(static_cast<int>(2 / edge) + 1) {
    cells_.resize(static_cast<std::size_t>(side_) * side_ * side_);
  }

  void add(const Sphere& s) {
    const Point c{s.x, s.y, s.z};
    const double reach = s.radius + edge_;
    std::array<int, 3> lo{}, hi{};
    for (std::size_t k = 0; k < 3; ++k) lo[k] = index(c[k] - reach), hi[k] = index(c[k] + reach);
    for (int x = lo[0]; x <= hi[0]; ++x) {
      for (int y = lo[1]; y <= hi[1]; ++y) {
        for (int z = lo[2]; z <= hi[2]; ++z) {
          if (distance2(c, {x, y, z}) < reach * reach) at(x, y, z).push_back(s);
        }
      }
    }
  }

  /// Distance from p to the nearest sphere, at most one edge; something not above `enough` if it is not above
  /// that.
  double clearance(const Point& p, double enough) {
    double best = edge_;
    for (const Sphere& s : at(index(p[0]), index(p[1]), index(p[2]))) {
      best = std::min(best, std::hypot(p[0] - s.x, p[1] - s.y, p[2] - s.z) - s.radius);
      if (best <= enough) break;
    }
    return best;
  }

 private:
  int index(double x) const { return std::clamp(static_cast<int>((x + 1) / edge_), 0, side_ - 1); }
  std::vector<Sphere>& at(int x, int y, int z) {
    return cells_[static_cast<std::size_t>((x * side_ + y) * side_ + z)];
  }
  double distance2(const Point& p, const std::array<int, 3>& cell) const {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double lo = cell[k] * edge_ - 1;
      const double d = std::max({lo - p[k], p[k] - lo - edge_, 0.0});
      sum += d * d;
    }
    return sum;
  }

  double edge_;
  int side_;
  std::vector<std::vector<Sphere>> cells_;
};

}  // namespace

std::shared_ptr<const Packing> greedyBall(std::size_t spheres, std::uint64_t seed) {
  constexpr int kTries = 200;
  constexpr double kGap = 1e-6;  // of a radius: what rounding to single precision could take
  std::mt19937_64 random(seed);
  const auto uniform = [&] { return std::ldexp(static_cast<double>(random() >> 11), -52) - 1; };
  // The first spheres are larger than a cell, so they are compared with each other.
  constexpr std::size_t kFirst = 100;
  Cells cells(std::min(0.25, 2.5 / std::cbrt(static_cast<double>(spheres))));
  auto packing = std::make_shared<Packing>();
  while (packing->spheres.size() < spheres) {
    Point best{};
    double radius = 0;
    for (int i = 0; i < kTries; ++i) {
      const Point p{uniform(), uniform(), uniform()};
      double r = 1 - std::hypot(p[0], p[1], p[2]);
      if (r <= radius) continue;
      if (packing->spheres.size() < kFirst) {
        for (const Sphere& s : packing->spheres)
          r = std::min(r, std::hypot(p[0] - s.x, p[1] - s.y, p[2] - s.z) - s.radius);
      } else {
        r = std::min(r, cells.clearance(p, radius));
      }
      if (r > radius) radius = r, best = p;
    }
    if (!(radius > 0)) continue;
    const Sphere s{static_cast<float>(best[0]), static_cast<float>(best[1]), static_cast<float>(best[2]),
                   static_cast<float>(radius * (1 - kGap))};
    packing->spheres.push_back(s);
    cells.add(s);
  }
  std::stable_sort(packing->spheres.begin(), packing->spheres.end(),
                   [](const Sphere& a, const Sphere& b) { return a.radius > b.radius; });
  return packing;
}

}  // namespace innersphere::benchmarks
