// Branch and bound in one brick of the octree.
#pragma once

#include <span>
#include <vector>

#include "packer/cells.hpp"
#include "packer/container.hpp"
#include "packer/max_min.hpp"
#include "packer/soundings.hpp"
#include "packer/sphere_grid.hpp"

namespace innersphere {

/// Finds, in a group of neighbouring cells, centres of spheres larger than a threshold, or proves that there
/// are none.
///
/// The largest radius at x is f(x) = min(distance to the surface, distances to the placed spheres). Each
/// distance is bounded from above by the distance to a ball (see Ball), a convex function. In a cell, the
/// balls' linearisations at a few points give a linear programme (Kelley's cutting planes). Its optimum is
/// the next point to try; its dual weights w prove the bound  f <= max over the corners of sum w_i
/// distance_i,  because a convex function is largest at a corner. That bound is tight to second order in the
/// cell's size, so cells need not become small.
class CellSearch {
 public:
  struct Candidate {
    Ball ball;
    std::uint64_t order = 0;  ///< place along the Z-order curve, decides between equal radii
  };

  struct Result {
    std::vector<Cell> cells;            ///< the live leaves, with their bounds
    std::vector<Candidate> candidates;  ///< disjoint within this brick, larger than the threshold
  };

  /// `top`: no sphere larger than this fits. `threshold`: the smallest radius of interest.
  CellSearch(const Container& container, const SphereGrid& placed, float top, float threshold)
      : container_(container), placed_(placed), top_(top), threshold_(threshold) {}

  Result search(std::span<const Cell> cells);

 private:
  enum class Verdict { below, found, undecided };

  struct Probe {
    double value;    ///< radius possible at the point, or more where that is below the threshold
    Point gradient;  ///< of the ball's distance
    Ball ball;       ///< the obstacle that determines it
  };

  void gather(std::span<const Cell> cells);
  void visit(const Cell& cell, std::size_t begin, std::size_t end);
  Verdict bound(Cell& cell, std::size_t begin);
  double provenBound(const MaxMin& program, std::span<const Ball> balls, const Point& centre,
                     double half) const;
  bool climb(Point x);

  Probe nearestBall(const Point& x, std::size_t begin, std::size_t end) const;
  Probe probe(const Point& x, std::size_t begin, std::size_t end, double enough, double negligible);

  const Container& container_;
  const SphereGrid& placed_;
  const float top_;
  const float threshold_;
  Result result_;
  Soundings soundings_;
  std::vector<Ball> balls_;  // a stack: those that matter in the brick, then those that matter in the cell
                             // being visited, ...
  std::size_t brick_balls_ = 0;
};

}  // namespace innersphere
