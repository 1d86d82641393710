// Meshes for scenes: prisms over flat outlines, bodies turned on a lathe, bent tubes, lumps.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
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

/// Cells of a grid with these lines. A row of `cells` is a row of them, the first one at the highest y; "#"
/// is filled.
Outline gridOutline(const std::vector<double>& xs, const std::vector<double>& ys,
                    const std::vector<std::string>& cells);

/// n points of a circle about the origin.
std::vector<Point2> circlePoints(double radius, int n);

/// The outline, as high as `height`, standing on z = 0.
Mesh prism(const Outline& outline, double height);

/// A body of revolution about the z axis: the profile's points are (distance from the axis, z) and go around
/// the cross section counter-clockwise, from one point on the axis to another.
Mesh lathe(const std::vector<Point2>& profile, int around);

/// A round tube along a path in the xy plane with a radius at each of its points; closed to a ring, or with
/// flat ends.
Mesh tube(const std::vector<Point2>& path, const std::vector<double>& radii, int around, bool closed);

/// A ball of radius 1 whose surface is moved out to `radius`, a function of the direction, > 0. Each of the
/// eight faces that it starts with is cut into four, `times` times.
Mesh lump(const std::function<double(const Vec3d&)>& radius, int times);

/// The other mesh too, each of its points moved by `map`, which does not mirror.
void append(Mesh& mesh, const Mesh& other, const std::function<Vec3d(const Vec3d&)>& map);

}  // namespace innersphere::demo
