// Declares the search for triangles whose boxes meet.
#pragma once

#include <cstddef>
#include <vector>

#include "surface/grid_surface.hpp"

namespace innersphere {

/// Holds pairs of nodes, or of triangles: one of A and one of B.
struct Pairs {
  std::vector<GridSurface::Index> a, b;  ///< at least `count` of each
  std::size_t count = 0;

  void makeRoom(std::size_t more) {
    if (a.size() >= count + more) return;
    a.resize(2 * (count + more));
    b.resize(2 * (count + more));
  }
};

/// Finds pairs of triangles that have boxes that meet. Those that are in several boxes may come more than
/// once.
void findPairs(GridSurface& a, GridSurface& b, Pairs& found);

}  // namespace innersphere
