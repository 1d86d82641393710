// Fills a solid with spheres.
#pragma once

#include <cstddef>

#include "innersphere/packing.hpp"
#include "innersphere/progress.hpp"
#include "innersphere/solid.hpp"

namespace innersphere {

/// Says when the packer stops, how greedy it is and what it measures. The first limit that is reached ends
/// the packing. A limit of 0 is not set. Options out of range make pack() throw Error bad_argument.
struct PackOptions {
  /// The number of spheres at which the packer stops. 0: no limit.
  std::size_t spheres = 10000;
  /// The smallest radius [m]. No smaller sphere is placed, and every sphere that fits and is 0.25 % larger
  /// is. 0: 1e-4 of the diagonal of the solid's bounding box. The packer uses at least 1e-5 of the longest
  /// side.
  double min_radius = 0;
  /// The fraction of the solid, 0 to 1, at which the packer stops once the spheres fill it. 0: no limit.
  double density = 0;
  /// The packer stops when none of 50,000 points spread over the surface is farther than this from a sphere
  /// [m]. 0: no limit.
  double gap = 0;
  /// What the first spheres are chosen for. SphereOrder::coverage places a few of the largest spheres, then
  /// spheres all over the surface until none of those points is farther than a hundredth of the diagonal from
  /// one, and then again the largest. It needs a surface.
  SphereOrder order = SphereOrder::radius;
  /// Each sphere has at least 1/(1+delta) of the largest radius possible when it is placed, 0.001 to 1. A
  /// smaller delta is denser and slower: 0.1 costs 0.03 points of density against 0.01, and placing is three
  /// times faster. The first 300 spheres decide most. As long as there are few places to look at they are
  /// placed with 0.01 in any case: in most solids half of them or more, in a shell none.
  double delta = 0.1;
  /// Whether Packing::overlap_errors are measured. No simulation reads them, and they take half of the time
  /// of a small packing: 1 of 2 CPU seconds for two meshes of 600 and 900 triangles with 256 spheres each.
  /// Programs that pack at their start should turn this off. The spheres and all else are the same; only
  /// BoundedOverlap::error is NaN.
  bool overlap_errors = true;
  /// The number of threads. 0: all cores. The result does not depend on it.
  int threads = 0;
};

/// Packs a solid by certified greedy insertion and returns the packing. It ends before all limits when the
/// solid is full: a ball after one sphere. Whatever ended it, the certificate says how large a sphere could
/// still fit. Size and place of the solid do not matter: the same solid gives the same spheres, to single
/// precision. Where two places are equally good, as in symmetric solids or a million sizes away, rounding
/// decides. Throws Error: bad_argument (also for walls so thin that the search would need more than some 3
/// GB), no_sphere_fits, not_finite (the solid's distances), cancelled.
Packing pack(const Solid& solid, const PackOptions& options = {}, const Progress& progress = {});

}  // namespace innersphere
