// The half of CellSearch that looks at single points: radii, and the way up to a local maximum.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "packer/cell_search.hpp"

namespace innersphere {
namespace {

Point direction(const Point& from, const Point& to) {
  const Point way = to - from;
  const double length = way.norm();
  return length > 0 ? Point(way / length) : Point(Point::UnitX());
}

}  // namespace

CellSearch::Probe CellSearch::nearestBall(const Point& x, std::size_t begin, std::size_t end) const {
  double best = std::numeric_limits<double>::infinity();
  std::size_t nearest = end;
  for (std::size_t i = begin; i < end; ++i) {
    const double reach = best + balls_[i].radius;
    const double squared = (x - balls_[i].centre).squaredNorm();
    if (reach > 0 && squared < reach * reach) {
      best = std::sqrt(squared) - balls_[i].radius;
      nearest = i;
    }
  }
  if (nearest == end) return {best, Point::Zero(), {}};
  return {best, direction(balls_[nearest].centre, x), balls_[nearest]};
}

CellSearch::Probe CellSearch::probe(const Point& x, std::size_t begin, std::size_t end, double enough,
                                    double negligible) {
  const Probe ball = nearestBall(x, begin, end);
  if (ball.value <= enough) return ball;
  if (const Soundings::Sounding* known = soundings_.around(x)) {
    if (known->distance < 0) {
      const Ball empty{known->at, -known->distance};
      return {empty.distance(x), direction(empty.centre, x), empty};
    }
    if (known->clearance(x) >= ball.value) return ball;
  }
  const Container::Nearest surface = container_.closest(x, ball.value);
  const double distance = std::min(surface.distance, ball.value);
  const Probe wall{distance, direction(surface.point, x), {surface.point, 0}};
  if (distance <= negligible) return wall;
  int side = soundings_.side(x, distance);
  if (side == 0) side = container_.contains(x) ? 1 : -1;
  soundings_.add(x, side * distance);
  if (side < 0) return {-distance, direction(x, surface.point), {x, distance}};
  return distance == ball.value ? ball : wall;
}

bool CellSearch::climb(Point x) {
  const Point start = x;
  Probe best = probe(x, 0, brick_balls_, 0, 0);
  double half = 0.5 * best.value;
  while (half > 1e-4 * best.value) {
    // As long as the cube keeps to the ball about x, all of it lies inside the solid.
    half = std::min({half, 0.55 * best.value});
    if ((x - start).norm() + 1.75 * half > threshold_) break;
    const double before = best.value;
    const Point centre = x;
    MaxMin program(half);
    program.add(best.value, best.gradient);
    for (std::size_t i = 0; i < brick_balls_; ++i) {
      const double distance = balls_[i].distance(centre);
      if (distance < best.value + 3.5 * half) program.add(distance, direction(balls_[i].centre, centre));
    }
    for (int step = 0; step < 10 && program.optimum() > best.value * (1 + 1e-5); ++step) {
      const Point y = centre + program.argmax();
      const Probe p = probe(y, 0, brick_balls_, best.value, 0);
      if (p.value > best.value) {
        best = p;
        x = y;
      }
      if (program.optimum() - p.value < 1e-5 * best.value) break;
      program.add(p.value - p.gradient.dot(y - centre), p.gradient);
    }
    const bool at_wall = (x - centre).cwiseAbs().maxCoeff() > 0.9 * half;
    if (best.value < before * (1 + 1e-4)) {
      half /= 8;
    } else if (!at_wall) {
      half /= 2;
    }
  }
  const Point snapped = container_.snap(x);
  const Ball ball = container_.fit(snapped, probe(snapped, 0, brick_balls_, 0, 0).value);
  if (!(ball.radius > 0)) return false;
  for (const Candidate& other : result_.candidates) {
    if (other.ball.distance(ball.centre) < ball.radius) return true;
  }
  Cell place;
  place.level = 20;
  for (int k = 0; k < 3; ++k) place.at[k] = static_cast<std::uint32_t>(std::ldexp(ball.centre[k], 20));
  result_.candidates.push_back({ball, mortonCode(place, 20)});
  return true;
}

}  // namespace innersphere
