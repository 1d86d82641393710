// Fills a solid with spheres.
#pragma once

#include <cstddef>

#include "innersphere/packing.hpp"
#include "innersphere/progress.hpp"
#include "innersphere/solid.hpp"

namespace innersphere {

/// When to stop and how greedy to be. The first limit that is reached ends the packing; a limit of 0 is not set.
struct PackOptions {
  std::size_t spheres = 10000;  ///< stop at exactly this many; 0: no limit
  double min_radius = 0;        ///< [m] place no smaller sphere; 0: 1e-4 of the solid's bounding-box diagonal
  double density = 0;           ///< stop when the spheres fill this fraction of the solid, 0 to 1
  double gap = 0;               ///< [m] stop when no surface point is farther than this from a sphere
  /// Each sphere has at least 1/(1+delta) of the largest radius possible when it is placed. Smaller is denser and
  /// slower: 0.1 costs 0.1 points of density against 0.01 and is four times faster.
  double delta = 0.1;
  int threads = 0;              ///< 0: all cores. The result does not depend on it.
};

/// Packs a solid by certified greedy insertion. Throws Error: bad_argument, no_sphere_fits, cancelled.
Packing pack(const Solid& solid, const PackOptions& options = {}, const Progress& progress = {});

}  // namespace innersphere
