// Meshes for scenes: prisms over flat outlines, and bodies turned on a lathe.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "innersphere/geometry.hpp"

namespace innersphere::demo {

using Point2 = std::array<double, 2>;

/// A region of the xy plane, cut into triangles that share their corners.
struct Outline {
  std::vector<Point2> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise

  std::uint32_t add(const Point2& point);
  /// Corners counter-clockwise.
  void addQuad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
};

/// What is between two closed curves with equally many points, both counter-clockwise.
Outline ringOutline(const std::vector<Point2>& outer, const std::vector<Point2>& inner);

/// n points of a circle about the origin.
std::vector<Point2> circlePoints(double radius, int n);

/// The outline, as high as `height`, standing on z = 0.
Mesh prism(const Outline& outline, double height);

/// A body of revolution about the z axis: the profile's points are (distance from the axis, z) and go around
/// the cross section counter-clockwise, from one point on the axis to another.
Mesh lathe(const std::vector<Point2>& profile, int around);

}  // namespace innersphere::demo
