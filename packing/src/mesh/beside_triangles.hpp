// Finds what is beside the triangles of a mesh.
#pragma once

#include <limits>
#include <vector>

#include "mesh/closest_triangle.hpp"
#include "mesh/winding_tree.hpp"

namespace innersphere {

constexpr int kUnknownWinding = std::numeric_limits<int>::min();

/// Says what is beside a triangle, for points to which it is the nearest one.
struct BesideTriangle {
  int winding_in_front = 0;  ///< or kUnknownWinding; behind it the number is larger by 1
  /// Nothing around it faces another way by 84 degrees or more: in front of its plane is in front of it, also
  /// where an edge or a corner of it is nearest.
  bool gentle = false;
};

/// Returns this of each triangle. `touched`: as of Cuts; winding numbers beside these are unknown. Without
/// `may_overlap` all numbers in front are 0.
std::vector<BesideTriangle> findBeside(const Mesh& mesh, const std::vector<bool>& touched, bool may_overlap,
                                       const ClosestTriangle& closest, const WindingTree& winding);

}  // namespace innersphere
