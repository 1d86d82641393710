// An independent judge of packings, in double precision, that shares no code with the packer.
#pragma once

#include <cstddef>

#include "innersphere/packing.hpp"
#include "innersphere/solid.hpp"

namespace innersphere {

/// The worst violations found. Positive numbers are violations; a valid packing has both at or below zero.
struct CheckReport {
  double worst_overlap = 0;     ///< r_i + r_j - |c_i - c_j| [m], the largest over all pairs
  std::size_t overlap_i = 0;    ///< the pair it belongs to
  std::size_t overlap_j = 0;    ///< the other sphere of that pair
  double worst_protrusion = 0;  ///< how far a sphere reaches out of the solid [m]; only with a solid
  std::size_t protruding = 0;   ///< the sphere it belongs to
  bool sorted = true;           ///< radii fall
  double density = 0;           ///< volume of the spheres over volume of the solid; 0 without a known volume

  /// Whether there is no violation.
  bool valid() const { return worst_overlap <= 0 && worst_protrusion <= 0 && sorted; }
};

/// Checks a packing by itself and, if `solid` is not null, against its solid.
CheckReport check(const Packing& packing, const Solid* solid = nullptr);

}  // namespace innersphere
