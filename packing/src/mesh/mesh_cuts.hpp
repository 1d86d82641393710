// Finds triangles that cut each other.
#pragma once

#include <cstddef>
#include <vector>

#include "innersphere/mesh.hpp"

namespace innersphere {

/// Holds how many pairs of triangles cut each other.
struct Cuts {
  std::size_t pairs = 0;
  Vec3d at{};  ///< a corner of one of the first pair [m]
  /// Of each triangle: whether others may cut or touch it elsewhere than in common corners and sides.
  std::vector<bool> touched;
};

/// Finds the pairs of triangles of which one has an edge that passes through the other, away from common
/// corners. Triangles that touch, or overlap within one plane, do not count.
Cuts findCuts(const Mesh& mesh);

/// Whether an edge of one of them passes through a triangle of the other.
bool cutEachOther(const Mesh& a, const Mesh& b);

}  // namespace innersphere
