// Finds words for what is wrong with a mesh.
#pragma once

#include <string>

#include "innersphere/mesh.hpp"
#include "mesh/mesh_topology.hpp"

namespace innersphere {

/// Returns a number with its noun: "1 open edge", "5 open edges".
std::string counted(std::size_t n, const std::string& thing);

/// Returns a number with four digits, for people.
std::string text(double x);
/// Returns a place in the same way, in parentheses.
std::string text(const Vec3d& p);

/// Fills in the counts of `topology` and the place of the longest loop of unbalanced edges.
void describe(const Topology& topology, const Mesh& mesh, MeshReport& report);

/// Throws Error unless there are triangles with usable corners: empty_input, not_finite, bad_argument.
void requireTriangles(const Mesh& mesh, const std::string& name);

/// Throws Error not_a_solid, which says why and what to do about it. Repair welds what is open within
/// `weld`, relative to the diagonal.
[[noreturn]] void refuse(const MeshReport& report, const std::string& name, double weld);

}  // namespace innersphere
