// Triangles that cut each other.
#pragma once

#include <cstddef>

#include "innersphere/mesh.hpp"

namespace innersphere {

struct Cuts {
  std::size_t pairs = 0;
  Vec3d at{};  ///< a corner of one of the first pair
};

/// Finds the pairs of triangles of which one has an edge that passes through the other, away from common
/// corners. Triangles that touch, or overlap within one plane, do not count.
Cuts findCuts(const Mesh& mesh);

}  // namespace innersphere
