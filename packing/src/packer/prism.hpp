// The part of space behind a triangle of the surface, as an obstacle.
#pragma once

#include <array>

#include "packer/ball.hpp"

namespace innersphere {

/// The corners of a cube, a row for each, and a number for each.
using CubeCorners = Eigen::Array<double, 8, 3>;
using CornerValues = Eigen::Array<double, 8, 1>;
CubeCorners cornersOf(const Point& centre, double half);

/// This is the prism behind a triangle of the surface, without end. A point in front of the triangle is at
/// least as near to the triangle as to the prism, so no sphere about it is larger than its distance from the
/// prism, a convex function. Behind the triangle that need not hold, for what lies there may be inside of the
/// solid again; there the distance from the triangle itself is the bound. Unlike a ball, a prism does not
/// curve away from a flat wall.
class Prism {
 public:
  /// Builds the prism. `inwards` is the unit normal of the triangle that points into the solid.
  Prism(const std::array<Point, 3>& corners, const Point& inwards);

  /// Tells of a ball outside of the solid: what is in it has no sphere about it, so less is left behind the
  /// triangle.
  void back(const Ball& outside) { outside_ = outside; }

  /// Finds the distances of a cube's corners from the prism; they are negative inside. Returns the largest
  /// distance from the triangle that a point of the cube behind the triangle's plane can have if a sphere is
  /// about it; 0 if there is none.
  double farthestBehind(const CubeCorners& cube, CornerValues& distances) const;

 private:
  /// Returns how deep behind the triangle a point of the cube can be that is not in the ball outside; `depth`
  /// if that does not tell.
  double deepest(const CubeCorners& cube, double depth) const;
  /// Returns how far x is beside the prism, and `height` above the triangle; if it is not, 0.
  double beside(const Point& x, double height) const;

  std::array<Point, 3> corners_;
  Point inwards_;
  Ball outside_{Point::Zero(), 0};
  std::array<Point, 3> outwards_;  // of the edge that starts at each corner, in the plane
};

}  // namespace innersphere
