// The part of CellSearch that looks at single points.
#include <algorithm>
#include <cmath>
#include <limits>

#include "packer/cell_search.hpp"

namespace innersphere {
namespace {

// Radius of the balls put behind walls, in wanted radii, at least. Smaller ones seldom prove anything.
constexpr double kLeastBehind = 2;

}  // namespace

Point CellSearch::direction(const Point& from, const Point& to) {
  const Point way = to - from;
  const double length = way.norm();
  return length > 0 ? Point(way / length) : Point(Point::UnitX());
}

CellSearch::Probe CellSearch::nearestBall(const Point& x, std::size_t begin, std::size_t end) const {
  double best = std::numeric_limits<double>::infinity();
  std::size_t nearest = end;
  for (std::size_t i = begin; i < end; ++i) {
    const double distance = balls_[i].distance(x);
    if (distance < best) {
      best = distance;
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
  if (const ClearanceCache::Entry* known = clearances_.around(x)) {
    if (known->distance < 0) {
      const Ball empty{known->at, -known->distance};
      return {empty.distance(x), direction(empty.centre, x), empty};
    }
    if (known->clearance(x) >= ball.value) return ball;
  }
  const Container::Nearest wall = container_.closest(x, ball.value);
  const double distance = std::min(wall.distance, ball.value);
  if (distance <= negligible) return {distance, direction(wall.point, x), {wall.point, 0}};
  if (!isInside(x, distance, wall))
    return {-distance,    direction(x, wall.point), {x, distance}, std::isfinite(wall.distance), wall.point,
            wall.triangle};
  if (distance == ball.value) return ball;
  return {distance, direction(wall.point, x), {wall.point, 0}, true, wall.point, wall.triangle};
}

bool CellSearch::isInside(const Point& x, double distance, const Container::Nearest& wall) {
  int side = clearances_.side(x, distance);
  if (side == 0) side = container_.contains(x, wall) ? 1 : -1;
  clearances_.add(x, side * distance);
  return side > 0;
}

Ball CellSearch::ballBehind(const Point& wall, const Point& normal, double radius) {
  const Ball ball = container_.emptyBall(wall, normal, kLeastBehind * wanted_, radius);
  // Inside where the wall is a sheet without thickness.
  return ball.radius == 0 || isInside(ball.centre, ball.radius, {}) ? Ball{wall, 0} : ball;
}

}  // namespace innersphere
