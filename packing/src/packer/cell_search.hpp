// Searches one block of the octree by branch and bound.
#pragma once

#include <span>
#include <vector>

#include "packer/cells.hpp"
#include "packer/clearance_cache.hpp"
#include "packer/container.hpp"
#include "packer/dual_simplex.hpp"
#include "packer/prism.hpp"
#include "packer/sphere_grid.hpp"

namespace innersphere {

/// Finds, in a group of neighbouring cells, centres of spheres larger than a given radius, or proves that
/// there are none.
///
/// The largest radius at x is f(x) = min(distance to the surface, distances to the placed spheres). Each of
/// these is at most the distance to some ball (see Ball), a convex function. In a cell, the balls'
/// linearisations at a few points give a linear programme (Kelley's cutting planes). Its optimum is the next
/// point to try, and its dual weights w prove
///   f <= max over the cell's corners of sum w_i distance_i,
/// because a convex function is largest at a corner. This bound is tight to second order in the cell's size,
/// where the usual Lipschitz bound is tight to first order: cells need not become small.
class CellSearch {
 public:
  /// This is a sphere that was found to fit.
  struct Candidate {
    Ball ball;
    std::uint64_t order = 0;  ///< place along the Z-order curve, decides between equal radii
  };

  /// Tells what a search has found.
  struct Result {
    std::vector<Cell> cells;            ///< the live leaves, with their bounds
    std::vector<Candidate> candidates;  ///< disjoint within this block, larger than `wanted`
  };

  /// Prepares a search. `top`: no sphere larger than this fits. `wanted`: spheres larger than this are looked
  /// for. `bound`: a cell that holds none larger than this is done. As bound > wanted, a cell is decided
  /// before it is much smaller than their difference. `equally_thick`: much of the solid is just too thin.
  CellSearch(const Container& container, const SphereGrid& placed, double top, double bound, double wanted,
             bool equally_thick)
      : container_(container),
        placed_(placed),
        top_(top),
        bound_(bound),
        wanted_(wanted),
        equally_thick_(equally_thick),
        clearances_(container.margin()) {}

  /// Searches the cells of one block.
  Result search(std::span<const Cell> cells);

 private:
  // How far a climb may leave its cell, in wanted radii. Larger: better maxima, longer lists of balls.
  static constexpr double kWander = 1;

  enum class Verdict { below, found, undecided };

  /// This is the obstacle that determines the radius at a point x.
  struct Probe {
    double value;          ///< about x, a sphere has at most this radius; exactly this if it exceeds `enough`
    Point gradient;        ///< of value, away from the obstacle
    Ball ball;             ///< the obstacle
    bool at_wall = false;  ///< it stands for the surface, nearest at `wall`
    Point wall{};
    const Triangle* triangle = nullptr;  ///< that the wall consists of there, if that is known
    int prism = -1;                      ///< of prisms_, takes the place of the ball
  };

  void gather(std::span<const Cell> cells);

  /// Decides a cell, or divides it. The balls that can matter in it are among balls_[begin, end), those that
  /// its parent was bounded by are inherited_[parent, ...).
  void visit(const Cell& cell, std::size_t begin, std::size_t end, std::size_t parent);

  /// Lowers the cell's bound. The balls that can matter in it are balls_[begin, ...). What bounded its parent
  /// may be enough; else single points are looked at.
  Verdict bound(Cell& cell, std::size_t begin, std::size_t parent);

  /// Returns the bound proven by the programme's dual variables. Cut k of the programme is cuts_[k].
  double provenBound(const Point& centre, double half) const;

  /// Puts prisms behind the flat walls that hold the optimum down, for these do not curve. Returns false if
  /// there are none.
  bool straighten();

  /// Puts larger balls behind the walls that hold the optimum down, for they curve less. Returns false if
  /// there are none.
  bool flatten(double half);

  /// Puts prisms behind the walls that hold the optimum down, backed by the balls that flatten() found. Most
  /// of what is behind a wall is then known to be outside, and cells may be larger than the solid is thick.
  /// Returns false if there are none.
  bool back();

  /// Returns the largest empty ball, up to `radius`, that touches the surface at `wall` from outside; or just
  /// the point.
  Ball ballBehind(const Point& wall, const Point& normal, double radius);

  /// Moves up from x, where a sphere that is wanted fits, to a local maximum, and makes it a candidate.
  /// Returns false if the solid contradicts itself there.
  bool climb(Point x);

  /// Looks at balls_[begin, end) and, if those leave more than `enough`, at the surface. The side of a point
  /// that is no farther than `negligible` from the surface does not matter.
  Probe probe(const Point& x, std::size_t begin, std::size_t end, double enough, double negligible);
  Probe nearestBall(const Point& x, std::size_t begin, std::size_t end) const;

  /// Returns true if x is inside. It is `distance` away from the surface, or more if that is not known.
  bool isInside(const Point& x, double distance, const Container::Nearest& wall);

  static Point direction(const Point& from, const Point& to);

  const Container& container_;
  const SphereGrid& placed_;
  const double top_, bound_, wanted_;
  const bool equally_thick_;
  Result result_;
  ClearanceCache clearances_;
  // A stack: the balls that can matter in the block, those of them that can matter in its cell being visited,
  // and so on.
  std::vector<Ball> balls_;
  std::size_t block_balls_ = 0;
  std::vector<Ball> inherited_;  // a stack, too: by these, cells were bounded that had to be divided
  // Of the cell being bounded, and of the cube of a climb.
  std::vector<Probe> cuts_;
  std::vector<Prism> prisms_;
  DualSimplex program_, climb_program_;
};

}  // namespace innersphere
