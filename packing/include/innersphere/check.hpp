// Judges packings in double precision, without any code of the packer's.
#pragma once

#include <cstddef>

#include "innersphere/packing.hpp"
#include "innersphere/solid.hpp"

namespace innersphere {

/// Holds the worst violations that check() found. Positive lengths are violations; a valid packing has both
/// at or below zero. A sphere that is not finite makes both infinite.
struct CheckReport {
  double worst_overlap = 0;     ///< The largest r_i + r_j - |c_i - c_j| over all pairs of spheres [m].
  std::size_t overlap_i = 0;    ///< The first sphere of that pair.
  std::size_t overlap_j = 0;    ///< The second sphere of that pair.
  double worst_protrusion = 0;  ///< How far a sphere reaches out of the solid at most [m]. 0 without a solid.
  std::size_t protruding = 0;   ///< The sphere that reaches out farthest.
  bool sorted = true;           ///< Whether no sphere is larger than the one before it.
  double density = 0;           ///< The volume of the spheres over that of the solid. 0 if that is unknown.

  /// Whether there is no violation.
  bool valid() const { return worst_overlap <= 0 && worst_protrusion <= 0 && sorted; }
};

/// Checks a packing by itself and, if `solid` is not null, against its solid. Takes any packing; what the
/// solid throws is passed on.
CheckReport check(const Packing& packing, const Solid* solid = nullptr);

}  // namespace innersphere
