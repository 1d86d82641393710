// Makes clean closed triangle meshes from a few curves.
#pragma once

#include <array>
#include <vector>

#include "innersphere/mesh.hpp"

namespace innersphere {

using Ring = std::vector<Vec3d>;
using Polygon = std::vector<std::array<double, 2>>;

/// Returns n points of a circle about the z axis at height z, counter-clockwise seen from above, the first at
/// angle 0.
Ring circle(double radius, double z, int n);

/// Returns a polygon of the xy plane, lifted to height z.
Ring lifted(const Polygon& polygon, double z);

/// Triangulates a simple polygon, counter-clockwise, by cutting ears. Returns indices into its points, wound
/// alike.
std::vector<std::array<std::uint32_t, 3>> triangulate(const Polygon& polygon);

/// Joins rings of equal length, each to the next, by strips whose diagonals run from point i to i + 1 of the
/// next ring. Counter-clockwise rings that go up enclose what is between them. With `closed` the last ring is
/// joined to the first. Otherwise the ends are closed: a ring of one point is the tip of a cone, a longer one
/// has to be flat, level and simple.
Mesh loft(const std::vector<Ring>& rings, bool closed);

/// Returns the mesh with its inside outside.
Mesh turned(Mesh mesh);

}  // namespace innersphere
