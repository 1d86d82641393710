// Makes one vertex of what is one point, removes triangles that are none, and joins meshes.
#pragma once

#include <cstddef>
#include <vector>

#include "innersphere/mesh.hpp"

namespace innersphere {

/// Merges vertices at equal positions and drops unused ones; the order of first use stays.
void weldEqual(Mesh& mesh);

/// Merges each vertex on an open edge into the first earlier one within `tolerance` [m]: `open` says of each
/// vertex whether it is on one. Returns how many went.
std::size_t weldClose(Mesh& mesh, const std::vector<bool>& open, double tolerance);

/// Removes triangles with two equal corners. Returns how many went.
std::size_t dropCollapsed(Mesh& mesh);

/// Removes triangles with three different corners and no area. Returns how many went.
std::size_t dropFlat(Mesh& mesh);

/// Removes triangles with the same corners, in the same sense, as an earlier one. Returns how many went.
std::size_t dropRepeated(Mesh& mesh);

/// Removes the second triangle of each two with the same corners in opposite senses. Returns how many went.
std::size_t dropTwins(Mesh& mesh);

/// Adds a mesh to another; nothing is merged.
void append(Mesh& mesh, const Mesh& more);

/// Turns a triangle over.
void flip(std::array<std::uint32_t, 3>& triangle);

}  // namespace innersphere
