#include "packer/cell_search.hpp"

#include <algorithm>
#include <cmath>

namespace innersphere {
namespace {

constexpr double kSqrt3 = 1.7320508075688773;

// How far a climb may leave its cell, in thresholds. Larger: better maxima, longer lists of balls.
constexpr double kWander = 1.0;

// A cell so small that it holds nothing but one maximum; its bound is then the threshold within this part of
// it.
constexpr double kFloor = 1e-3;

double farthestDistance(const Ball& ball, const Point& centre, double half) {
  return ((centre - ball.centre).array().abs() + half).matrix().norm() - ball.radius;
}

double nearestDistance(const Ball& ball, const Point& centre, double half) {
  return ((centre - ball.centre).array().abs() - half).max(0.0).matrix().norm() - ball.radius;
}

float roundUp(double x) {
  const float rounded = static_cast<float>(x);
  return rounded < x ? std::nextafter(rounded, 1.0f) : rounded;
}

}  // namespace

CellSearch::Result CellSearch::search(std::span<const Cell> cells) {
  gather(cells);
  for (const Cell& cell : cells) visit(cell, 0, brick_balls_);
  return std::move(result_);
}

void CellSearch::gather(std::span<const Cell> cells) {
  Point lower = Point::Constant(1), upper = Point::Constant(0);
  for (const Cell& cell : cells) {
    const double half = cell.side() / 2;
    lower = lower.cwiseMin(cell.centre() - Point::Constant(half));
    upper = upper.cwiseMax(cell.centre() + Point::Constant(half));
  }
  const Point centre = (lower + upper) / 2, half = (upper - lower) / 2;
  const double reach = top_ + kWander * threshold_;
  placed_.visitNear(lower, upper, reach, [&](std::uint32_t i) {
    const Ball& ball = placed_.balls()[i];
    const double distance = ((centre - ball.centre).cwiseAbs() - half).cwiseMax(0.0).norm() - ball.radius;
    if (distance < reach) balls_.push_back(ball);
  });
  brick_balls_ = balls_.size();
}

void CellSearch::visit(const Cell& cell, std::size_t begin, std::size_t end) {
  const Point centre = cell.centre();
  const double half = cell.side() / 2;
  Cell now = cell;
  double upper = cell.upper;
  for (std::size_t i = begin; i < end; ++i)
    upper = std::min(upper, farthestDistance(balls_[i], centre, half));
  now.upper = std::min(cell.upper, roundUp(upper));
  if (now.upper <= threshold_) {
    if (now.upper > 0) result_.cells.push_back(now);
    return;
  }
  for (const Candidate& candidate : result_.candidates) {
    if (farthestDistance(candidate.ball, centre, half) <= threshold_) {
      result_.cells.push_back(now);  // to be looked at again if the candidate fails
      return;
    }
  }
  const std::size_t mine = balls_.size();
  for (std::size_t i = begin; i < end; ++i) {
    if (nearestDistance(balls_[i], centre, half) < now.upper) balls_.push_back(Ball(balls_[i]));
  }
  const Verdict verdict = bound(now, mine);
  const bool small = kSqrt3 * half < kFloor * threshold_ || now.level == Cell::kDeepest;
  if (verdict == Verdict::undecided && small) now.upper = threshold_;
  if (verdict == Verdict::below || small || (verdict == Verdict::found && half < 0.5 * threshold_)) {
    if (now.upper > 0) result_.cells.push_back(now);
  } else {
    const std::size_t last = balls_.size();
    for (int octant = 0; octant < 8; ++octant) visit(now.child(octant), mine, last);
  }
  balls_.resize(mine);
}

CellSearch::Verdict CellSearch::bound(Cell& cell, std::size_t begin) {
  const Point centre = cell.centre();
  const double half = cell.side() / 2;
  MaxMin program(half);
  std::vector<Ball> cuts;
  // In a cell larger than the spheres sought the linear programme says little.
  const int most = half > threshold_ ? 1 : 12;
  Point x = centre;
  for (int k = 0; k < most; ++k) {
    const Probe p = probe(x, begin, balls_.size(), threshold_, k == 0 ? threshold_ - kSqrt3 * half : 0);
    if (p.value > threshold_ && climb(x)) return Verdict::found;
    program.add(p.value - p.gradient.dot(x - centre), p.gradient);
    cuts.push_back(p.ball);
    if (program.optimum() <= threshold_ || k == 0) {
      const double proven = provenBound(program, cuts, centre, half);
      cell.upper = std::min(cell.upper, roundUp(proven));
      if (cell.upper <= threshold_) return Verdict::below;
      if (program.optimum() <= threshold_) break;
    }
    x = centre + program.argmax();
  }
  return Verdict::undecided;
}

double CellSearch::provenBound(const MaxMin& program, std::span<const Ball> balls, const Point& centre,
                               double half) const {
  double corners[8] = {};
  program.forWeights([&](int k, double weight) {
    for (int corner = 0; corner < 8; ++corner) {
      const Point v = centre + half * Point(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      corners[corner] += weight * balls[k].distance(v);
    }
  });
  return *std::max_element(corners, corners + 8) + 1e-15;
}

}  // namespace innersphere
