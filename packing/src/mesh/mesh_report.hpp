// Words for what was found in a mesh.
#pragma once

#include <string>

#include "innersphere/mesh.hpp"
#include "mesh/mesh_topology.hpp"

namespace innersphere {

/// "1 open edge", "5 open edges".
std::string counted(std::size_t n, const std::string& thing);

/// Four digits, for people.
std::string text(double x);
std::string text(const Vec3d& p);

/// Fills in the counts of `topology` and the place of the longest loop of unbalanced edges.
void describe(const Topology& topology, const Mesh& mesh, MeshReport& report);

/// Throws Error: empty_input, not_finite, bad_argument, unless there are triangles with usable corners.
void requireTriangles(const Mesh& mesh, const std::string& name);

/// Throws Error not_a_solid, saying why and what to do about it.
[[noreturn]] void refuse(const MeshReport& report, const std::string& name);

}  // namespace innersphere
