#include "packer/near_balls.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace innersphere {
namespace {

// Where so few balls are left, or points, dividing costs more than it saves.
constexpr std::size_t kFewBalls = 8;

constexpr double kDistanceRounding = 1e-12;

/// Divides the points that lie in a cube with it, until few balls are left for each.
class Divider {
 public:
  Divider(std::span<const Point> points, std::vector<NearBalls::Nearest>& nearest)
      : points_(points), nearest_(nearest) {}

  void divide(std::span<std::uint32_t> mine, const Point& centre, double half, const NearBalls& balls) const {
    if (mine.size() <= kFewBalls || balls.size() <= kFewBalls) {
      for (std::uint32_t i : mine) nearest_[i] = balls.nearest(points_[i]);
      return;
    }
    std::array<std::span<std::uint32_t>, 8> parts;
    split(mine, centre, 2, 0, parts);
    const auto visit = [&](int octant) {
      if (parts[octant].empty()) return;
      const Point middle =
          centre + half / 2 * Point(octant & 1 ? 1 : -1, octant & 2 ? 1 : -1, octant & 4 ? 1 : -1);
      divide(parts[octant], middle, half / 2, NearBalls(balls, middle, half / 2));
    };
    if (half >= kSharedHalf) {
      tbb::parallel_for(0, 8, visit);
    } else {
      for (int octant = 0; octant < 8; ++octant) visit(octant);
    }
  }

 private:
  void split(std::span<std::uint32_t> mine, const Point& centre, int axis, int octant,
             std::array<std::span<std::uint32_t>, 8>& parts) const {
    if (axis < 0) {
      parts[octant] = mine;
      return;
    }
    const auto upper = std::partition(mine.begin(), mine.end(),
                                      [&](std::uint32_t i) { return points_[i][axis] < centre[axis]; });
    const auto below = static_cast<std::size_t>(upper - mine.begin());
    split(mine.first(below), centre, axis - 1, octant, parts);
    split(mine.subspan(below), centre, axis - 1, octant | 1 << axis, parts);
  }

  std::span<const Point> points_;
  std::vector<NearBalls::Nearest>& nearest_;
};

}  // namespace

NearBalls::NearBalls(std::span<const Ball> balls) : balls_(balls), near_(balls.size()) {
  std::iota(near_.begin(), near_.end(), 0u);
}

NearBalls::NearBalls(const NearBalls& parent, const Point& centre, double half) : balls_(parent.balls_) {
  const double reach = std::numbers::sqrt3 * half;
  static thread_local std::vector<double> distances;
  distances.resize(std::max(distances.size(), parent.near_.size()));
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < parent.near_.size(); ++i) {
    distances[i] = balls_[parent.near_[i]].distance(centre);
    least = std::min(least, distances[i]);
  }
  // A distance differs by no more than `reach` between the middle and any point of the cube.
  const double most = least + 2 * reach + kDistanceRounding;
  near_.resize(parent.near_.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < near_.size(); ++i) {
    near_[count] = parent.near_[i];
    count += distances[i] <= most;
  }
  near_.resize(count);
  inside_one_ = least <= -reach;
}

NearBalls::Nearest NearBalls::nearest(const Point& x) const {
  Nearest best{std::numeric_limits<double>::infinity(), 0};
  for (std::uint32_t i : near_) {
    const Ball& ball = balls_[i];
    const double reach = best.distance + ball.radius + kDistanceRounding;
    const double squared = (x - ball.centre).squaredNorm();
    if (reach <= 0 || squared >= reach * reach) continue;  // most, without a root
    const double distance = std::sqrt(squared) - ball.radius;
    if (distance < best.distance) best = {distance, i};
  }
  return best;
}

std::vector<NearBalls::Nearest> nearestBalls(std::span<const Point> points, std::span<const Ball> balls) {
  std::vector<NearBalls::Nearest> nearest(points.size());
  std::vector<std::uint32_t> all(points.size());
  std::iota(all.begin(), all.end(), 0u);
  Divider(points, nearest).divide(all, Point::Constant(0.5), 0.5, NearBalls(balls));
  return nearest;
}

}  // namespace innersphere
