#include "packer/cover.hpp"

#include <algorithm>
#include <cmath>

#include "packer/near_balls.hpp"
#include "packer/pattern_search.hpp"

namespace innersphere {
namespace {

// Cells of the samples' lattice along an edge of the unit cube.
constexpr std::size_t kCells = 32;

// The part of a gap within which a sphere is looked for.
constexpr double kReach = 0.5;

// A pattern search ends when its steps are this small a part of the radius.
constexpr double kFinest = 0.03;

}  // namespace

Cover::Cover(const Container& container, const SurfaceSamples& samples, const SphereGrid& placed,
             double min_radius)
    : container_(container),
      samples_(samples),
      placed_(placed),
      min_radius_(min_radius),
      clearances_(container.margin()) {
  const std::vector<Point>& points = samples.points();
  const auto cell = [&](const Point& x) {
    return (cellOf(x, 2) * kCells + cellOf(x, 1)) * kCells + cellOf(x, 0);
  };
  begins_.assign(kCells * kCells * kCells + 1, 0);
  for (const Point& x : points) ++begins_[cell(x) + 1];
  for (std::size_t i = 1; i < begins_.size(); ++i) begins_[i] += begins_[i - 1];
  std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
  order_.resize(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) order_[next[cell(points[i])]++] = i;
  if (placed.balls().empty()) {
    gaps_.assign(points.size(), 2);  // farther than anything in the unit cube
  } else {
    for (const NearBalls::Nearest& hit : nearestBalls(points, placed.balls())) gaps_.push_back(hit.distance);
    known_ = placed.balls().size();
  }
  for (std::uint32_t i = 0; i < points.size(); ++i) heap_.push_back({gaps_[i], i});
  std::make_heap(heap_.begin(), heap_.end());
}

std::size_t Cover::cellOf(const Point& x, int axis) const {
  return static_cast<std::size_t>(std::clamp(x[axis] * kCells, 0.0, kCells - 1.0));
}

/// Brings the farthest sample to the front of the heap, whose gaps may be old.
void Cover::settle() {
  while (!heap_.empty() && heap_.front().gap != gaps_[heap_.front().sample]) {
    std::pop_heap(heap_.begin(), heap_.end());
    heap_.back().gap = gaps_[heap_.back().sample];
    std::push_heap(heap_.begin(), heap_.end());
  }
}

/// Takes the balls into account that came since.
void Cover::update() {
  for (; known_ < placed_.balls().size(); ++known_) {
    const Ball& ball = placed_.balls()[known_];
    settle();
    const double reach = ball.radius + (heap_.empty() ? 0 : heap_.front().gap);
    std::size_t from[3], to[3];
    for (int k = 0; k < 3; ++k) {
      from[k] = cellOf(ball.centre - Point::Constant(reach), k);
      to[k] = cellOf(ball.centre + Point::Constant(reach), k);
    }
    for (std::size_t z = from[2]; z <= to[2]; ++z) {
      for (std::size_t y = from[1]; y <= to[1]; ++y) {
        const std::size_t row = (z * kCells + y) * kCells;
        for (std::uint32_t i = begins_[row + from[0]]; i < begins_[row + to[0] + 1]; ++i) {
          double& gap = gaps_[order_[i]];
          gap = std::min(gap, ball.distance(samples_.points()[order_[i]]));
        }
      }
    }
  }
  settle();
}

bool Cover::upTo(double gap, const std::function<bool(const Ball&)>& insert) {
  for (update(); !heap_.empty() && heap_.front().gap > gap; update()) {
    const std::uint32_t farthest = heap_.front().sample;
    const Ball ball =
        largestNear(samples_.points()[farthest], samples_.inwards()[farthest], kReach * gaps_[farthest]);
    if (ball.radius > min_radius_) {
      if (insert(ball)) return true;
    } else {
      std::pop_heap(heap_.begin(), heap_.end());  // no sphere comes nearer
      heap_.pop_back();
    }
  }
  return false;
}

/// The radius of the largest sphere about x, if it is more than `enough`; the surface is about `wall` away,
/// or nearer. In bare walls the nearest sphere is far, and looking for it first would mean to look at all.
double Cover::room(const Point& x, double enough, double wall) {
  const double limit = 2 * wall;
  const double alone = std::min(container_.closest(x, limit).distance, limit);
  if (alone <= enough) return 0;
  const double radius = std::min(placed_.nearest(x, alone).distance, alone);
  return radius > enough && clearances_.contains(container_, x, radius) ? radius : 0;
}

Ball Cover::largestNear(const Point& p, const Point& inwards, double reach) {
  Ball best{p, 0};
  double step = reach / 2;
  const auto look = [&](const Point& x) {
    const double away = (x - p).norm();
    if (away > reach) return false;
    const double radius = room(x, best.radius, away);
    if (radius <= best.radius) return false;
    best = {x, radius};
    return true;
  };
  for (double depth = reach; depth > min_radius_ && depth > best.radius; depth /= 2)
    look(p + depth * inwards);
  step = std::max(best.radius, reach / 8);
  while (step > kFinest * best.radius && step > kFinest * min_radius_) {
    const Point centre = best.centre;
    bool better = false;
    for (const Point& way : patternDirections()) better = look(centre + step * way) || better;
    if (!better) step /= 2;
  }
  return best;
}

}  // namespace innersphere
