// Fills a solid with spheres.
#pragma once

#include <cstddef>

#include "innersphere/packing.hpp"
#include "innersphere/progress.hpp"
#include "innersphere/solid.hpp"

namespace innersphere {

/// When to stop and how greedy to be. The first limit that is reached ends the packing; a limit of 0 is not
/// set.
struct PackOptions {
  std::size_t spheres = 10000;  ///< stop at exactly this many; 0: no limit
  /// [m] place no smaller sphere, and every one that is 0.25 % larger; 0: 1e-4 of the solid's bounding-box
  /// diagonal. At least 1e-5 of the longest side.
  double min_radius = 0;
  double density = 0;  ///< stop when the spheres fill this fraction of the solid, 0 to 1
  double gap = 0;      ///< [m] stop when no surface point is farther than this from a sphere
  /// Each sphere has at least 1/(1+delta) of the largest radius possible when it is placed, 0.001 to 1.
  /// Smaller is denser and slower: 0.1 costs 0.1 points of density against 0.01 and is four times faster. The
  /// first 300 spheres are placed with 0.01 in any case, for they decide most, unless the solid is a shell or
  /// the like, with many equal maxima.
  double delta = 0.1;
  int threads = 0;  ///< 0: all cores. The result does not depend on it.
};

/// Packs a solid by certified greedy insertion. Ends before all limits when the solid is full: a ball after
/// one sphere. Whatever ended it, the certificate says how large a sphere could still fit. Size and place of
/// the solid do not matter: the same solid gives the same spheres, to single precision, unless rounding
/// decides between equally good places, as in symmetric solids or a million sizes away. Throws Error:
/// bad_argument, no_sphere_fits, not_finite (the solid's distances), cancelled.
Packing pack(const Solid& solid, const PackOptions& options = {}, const Progress& progress = {});

}  // namespace innersphere
