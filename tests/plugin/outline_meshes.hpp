// Meshes made of outlines.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "innersphere/geometry.hpp"

class btTriangleMesh;

namespace innersphere::test {

/// A body of revolution about z: (distance from the axis, z) from one place on the axis to another,
/// counter-clockwise around the cross section.
Mesh turnedMesh(const std::vector<std::array<double, 2>>& profile, std::uint32_t around = 48);
/// The same of a closed cross section beside the axis: a ring.
Mesh ringMesh(const std::vector<std::array<double, 2>>& section, std::uint32_t around);
/// A prism along y, 1 m long, with this outline in x and z, counter-clockwise seen from y = -infinity, and
/// seen as a whole from its first place. Its sides, two triangles each, come first.
Mesh prismMesh(const std::vector<std::array<double, 2>>& outline);
/// A prism along y, 1 m long, between two outlines in x and z of as many places: of a ring, both closed and
/// counter-clockwise seen from y = -infinity, the first one outside; or of a channel, from end to end.
Mesh prismBetween(const std::vector<std::array<double, 2>>& outer,
                  const std::vector<std::array<double, 2>>& inner, bool closed);
/// The same in single precision.
Surface surfaceOf(const Mesh& mesh);
/// Adds all triangles of a mesh to one of Bullet's.
void addTriangles(const Mesh& mesh, btTriangleMesh& triangles);

}  // namespace innersphere::test
