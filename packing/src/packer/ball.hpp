// Declares the one kind of obstacle that the packer knows.
#pragma once

#include <Eigen/Core>
#include <numbers>

namespace innersphere {

/// This is a point or vector in the packer's own coordinates, in which the solid's bounding cube is the unit
/// cube.
using Point = Eigen::Vector3d;

/// The volume of a ball of radius 1.
constexpr double kBallVolume = 4.0 / 3.0 * std::numbers::pi;

/// This is something that a new sphere must not enter. Three things are balls: a sphere already placed, a
/// point of the surface (radius 0), and the empty ball around a point outside the solid. A sphere centred at
/// x has at most the radius distance(x), a convex function of x.
struct Ball {
  Point centre;
  double radius = 0;

  double distance(const Point& x) const { return (x - centre).norm() - radius; }
  double volume() const { return kBallVolume * radius * radius * radius; }
};

}  // namespace innersphere
