// Finds the closed shells of a mesh: which way they face and how they nest.
#pragma once

#include "innersphere/mesh.hpp"
#include "mesh/mesh_topology.hpp"

namespace innersphere {

/// Tells what orderShells() found and did.
struct ShellsReport {
  std::size_t count = 0;  ///< shells
  /// Whether the boxes of two shells meet, neither of which is inside the other.
  bool boxes_meet = false;
  /// The number of shells that faced inwards with nothing around them, with all that is inside them.
  std::size_t turned = 0;
  /// The number of shells that face inwards inside another: they are left as they are.
  std::size_t cavities = 0;
  /// The number of shells inside solid material that face outwards, so that they bound nothing.
  std::size_t removed = 0;
};

/// Makes every shell of a closed mesh face away from the material, where material is what has a positive
/// winding number. Shells that cut each other are left as they are.
ShellsReport orderShells(Mesh& mesh, const Topology& topology);

}  // namespace innersphere
