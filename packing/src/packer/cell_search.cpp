#include "packer/cell_search.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "mesh/triangle.hpp"

namespace innersphere {
namespace {

// In a cell whose half is larger than this many wanted radii, only the centre is looked at, unless the solid
// is equally thick everywhere: there most cells need not be divided.
constexpr double kLarge = 4;

// Points at which a cell is looked at before it is divided.
constexpr int kProbes = 12;

// A cell's bound is lowered beyond what its round asks for, so that the cell need not be looked at again in
// each of the next rounds: as long as one more point lowers it by the first part of what is asked for, or
// until it is at the second, about two rounds later.
constexpr double kWorthAPoint = 0.05, kLowEnough = 0.85;

// Radius of the balls put behind walls, in wanted radii. Larger: less curved, so that cells need not be as
// small, but dearer to find. That pays where the solid is equally thick everywhere.
constexpr double kBehind = 8, kFarBehind = 64;

// Cosine between a wall's direction and a triangle's, from which on the wall is the triangle.
constexpr double kFacing = 1 - 1e-6;

/// A cube, and the distances from a ball to its nearest and farthest points.
struct Cube {
  Point centre;
  double half;

  double farthest(const Ball& ball) const {
    return ((centre - ball.centre).array().abs() + half).matrix().norm() - ball.radius;
  }
  bool within(const Ball& ball, double distance) const {
    const double reach = distance + ball.radius;
    return ((centre - ball.centre).array().abs() + half).matrix().squaredNorm() < reach * reach;
  }
  bool near(const Ball& ball, double distance) const {
    const double reach = distance + ball.radius;
    return ((centre - ball.centre).array().abs() - half).max(0.0).matrix().squaredNorm() < reach * reach;
  }
};

/// The prism behind the triangle, in the packer's coordinates; nothing if the wall does not face as the
/// triangle does, which is so at edges.
std::optional<Prism> prismBehind(const Container& container, const Triangle& triangle, const Point& inwards) {
  const auto corners = triangle.cornersIfNotThin();
  if (!corners) return std::nullopt;
  const Point a = container.fromWorld((*corners)[0]), b = container.fromWorld((*corners)[1]),
              c = container.fromWorld((*corners)[2]);
  Point normal = (b - a).cross(c - a).normalized();
  if (normal.dot(inwards) < 0) normal *= -1;
  if (normal.dot(inwards) < kFacing) return std::nullopt;
  return Prism({a, b, c}, normal);
}

float roundUp(double x) {
  const float rounded = static_cast<float>(x);
  return rounded < x ? std::nextafter(rounded, 1.0f) : rounded;
}

}  // namespace

CellSearch::Result CellSearch::search(std::span<const Cell> cells) {
  gather(cells);
  for (const Cell& cell : cells) visit(cell, 0, block_balls_, 0);
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
  const double reach = top_ + kWander * wanted_;
  placed_.visitNear(lower, upper, reach, [&](std::uint32_t i) {
    const Ball& ball = placed_.balls()[i];
    const double distance = ((centre - ball.centre).cwiseAbs() - half).cwiseMax(0.0).norm() - ball.radius;
    if (distance < reach) balls_.push_back(ball);
  });
  block_balls_ = balls_.size();
}

void CellSearch::visit(const Cell& cell, std::size_t begin, std::size_t end, std::size_t parent) {
  container_.goOn();
  const double half = cell.side() / 2;
  const Cube cube{cell.centre(), half};
  Cell now = cell;
  double upper = cell.upper;
  for (std::size_t i = begin; i < end; ++i) {
    if (cube.within(balls_[i], upper)) upper = cube.farthest(balls_[i]);
  }
  now.upper = std::min(cell.upper, roundUp(upper));
  if (now.upper <= bound_) {
    if (now.upper > 0) result_.cells.push_back(now);
    return;
  }
  for (const Candidate& candidate : result_.candidates) {
    if (cube.within(candidate.ball, bound_)) {
      result_.cells.push_back(now);  // to be looked at again if the candidate fails
      return;
    }
  }
  const std::size_t mine = balls_.size();
  for (std::size_t i = begin; i < end; ++i) {
    if (cube.near(balls_[i], now.upper))
      balls_.push_back(Ball(balls_[i]));  // copied first: the stack may move
  }
  const Verdict verdict = bound(now, mine, parent);
  // A cell not larger than the sphere found in it waits for the next look. The deepest level is never
  // reached, unless the solid's distances contradict each other.
  if (now.level == Cell::kDeepest) now.upper = std::min(now.upper, roundUp(bound_));
  if (now.level == Cell::kDeepest || verdict == Verdict::below ||
      (verdict == Verdict::found && half < 0.5 * wanted_)) {
    if (now.upper > 0) result_.cells.push_back(now);
  } else {
    const std::size_t last = balls_.size(), ours = inherited_.size();
    for (const Probe& cut : cuts_) inherited_.push_back(cut.ball);
    for (int octant = 0; octant < 8; ++octant) visit(now.child(octant), mine, last, ours);
    inherited_.resize(ours);
  }
  balls_.resize(mine);
}

CellSearch::Verdict CellSearch::bound(Cell& cell, std::size_t begin, std::size_t parent) {
  const Point centre = cell.centre();
  const double half = cell.side() / 2;
  program_.restart(half);
  cuts_.clear();
  const auto prove = [&] {
    cell.upper = std::min(cell.upper, roundUp(provenBound(centre, half)));
    return cell.upper <= bound_;
  };
  const auto cut = [&](const Probe& p, const Point& at) {
    program_.add(p.value - p.gradient.dot(at - centre), p.gradient);
    cuts_.push_back(p);
  };
  for (std::size_t i = parent; i < inherited_.size(); ++i) {
    const Ball& ball = inherited_[i];
    cut({ball.distance(centre), direction(ball.centre, centre), ball}, centre);
  }
  if (!cuts_.empty() && program_.optimum() <= bound_ && prove()) return Verdict::below;
  Point x = centre;
  double before = std::numeric_limits<double>::infinity();
  const int probes = half > kLarge * wanted_ && !equally_thick_ ? 1 : kProbes;
  for (int k = 0; k < probes; ++k) {
    const Probe p = probe(x, begin, balls_.size(), wanted_, k == 0 ? bound_ - std::numbers::sqrt3 * half : 0);
    if (p.value > wanted_ && climb(x)) return Verdict::found;
    cut(p, x);
    const double optimum = program_.optimum();
    const bool worthwhile = k + 1 < probes && before - optimum > kWorthAPoint * bound_;
    if (optimum <= kLowEnough * bound_ || (optimum <= bound_ && !worthwhile)) {
      // If that is no proof, only the balls' curvature is in the way.
      const bool below = prove() || (straighten() && prove()) || (flatten(half) && prove()) ||
                         (equally_thick_ && back() && prove());
      return below ? Verdict::below : Verdict::undecided;
    }
    before = optimum;
    x = centre + program_.argmax();
  }
  return Verdict::undecided;
}

bool CellSearch::straighten() {
  bool straighter = false;
  prisms_.clear();
  program_.forWeights([&](int k, double) {
    Probe& cut = cuts_[k];
    if (!cut.triangle) return;
    const std::optional<Prism> prism = prismBehind(container_, *cut.triangle, cut.gradient);
    if (!prism) return;
    cut.prism = static_cast<int>(prisms_.size());
    prisms_.push_back(*prism);
    straighter = true;
  });
  return straighter;
}

bool CellSearch::flatten(double half) {
  bool flatter = false;
  program_.forWeights([&](int k, double) {
    if (!cuts_[k].at_wall) return;
    const Ball behind = ballBehind(cuts_[k].wall, -cuts_[k].gradient,
                                   (equally_thick_ ? kFarBehind : kBehind) * std::max(half, wanted_));
    if (behind.radius <= cuts_[k].ball.radius) return;
    cuts_[k].ball = behind;
    cuts_[k].prism = -1;
    flatter = true;
  });
  return flatter;
}

bool CellSearch::back() {
  bool backed = false;
  program_.forWeights([&](int k, double) {
    Probe& cut = cuts_[k];
    if (!cut.triangle || cut.ball.radius == 0) return;
    std::optional<Prism> prism = prismBehind(container_, *cut.triangle, cut.gradient);
    if (!prism) return;
    prism->back(cut.ball);
    cut.prism = static_cast<int>(prisms_.size());
    prisms_.push_back(*prism);
    backed = true;
  });
  return backed;
}

double CellSearch::provenBound(const Point& centre, double half) const {
  const CubeCorners corners = cornersOf(centre, half);
  CornerValues sums = CornerValues::Zero();
  double behind = 0;
  program_.forWeights([&](int k, double weight) {
    if (cuts_[k].prism < 0) {
      const Ball& ball = cuts_[k].ball;
      const CubeCorners way = corners.rowwise() - ball.centre.transpose().array();
      sums +=
          weight * ((way.col(0).square() + way.col(1).square() + way.col(2).square()).sqrt() - ball.radius);
    } else {
      CornerValues distances;
      behind = std::max(behind, prisms_[cuts_[k].prism].farthestBehind(corners, distances));
      sums += weight * distances;
    }
  });
  return std::max(behind, sums.maxCoeff()) + 4e-15;
}

}  // namespace innersphere
