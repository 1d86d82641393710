// Closes what is open in a mesh.
#pragma once

#include <cstddef>

#include "innersphere/mesh.hpp"
#include "mesh/mesh_topology.hpp"

namespace innersphere {

/// Splits triangles at vertices of unbalanced edges that lie on such an edge, within `tolerance` [m]: meshes
/// that were refined in parts are open there, though their surface has no hole. Returns how many edges were
/// split.
std::size_t splitAtVertices(Mesh& mesh, const Topology& topology, double tolerance);

/// Closes each loop of unbalanced edges, so that no sphere bulges far through a hole and the winding number
/// is an integer everywhere: with a ring if it is the rim around one other in its plane, as of a pipe, else
/// with a fan around its middle. Returns how many triangles were added.
std::size_t closeLoops(Mesh& mesh, const Topology& topology);

}  // namespace innersphere
