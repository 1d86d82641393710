// Finds the volume that two solids share from the triangles of their surfaces.
#pragma once

#include <cstdint>

#include "innersphere/geometry.hpp"
#include "surface/grid_surface.hpp"
#include "surface/lanes.hpp"
#include "surface/surface_tree.hpp"

namespace innersphere {

/// Says which surface it is, and where.
struct PlacedSurface {
  const SurfaceTree& tree;
  Similarity place;
};

/// Holds integrals over what A and B share.
struct SharedSums {
  double volume = 0;
  Vec3d moment{};           ///< of the volume, about the origin
  Vec3d area{};             ///< the integral of the outward normal over B's surface in A
  Vec3d turning{};          ///< the integral of place x outward normal there
  double wetted = 0;        ///< the area of B's surface in A
  std::uint64_t pairs = 0;  ///< of triangles that meet
};

/// Returns the sums for the volume that A and B share. It is bounded by A's surface as far as that is in B,
/// and by B's as far as that is in A, so by the divergence theorem
///
///   V = 1/3 sum over triangles t of A of the integral over t of w_B x . n,  and the same with A and B
///   exchanged,
///
/// where w_B is how often B encloses x. On t it changes by one along the lines in which t and triangles of B
/// meet. So only pairs of triangles that meet are looked at one by one; to all others w_B comes over the
/// edges that they share. Where a surface encloses a part of space twice, that part counts twice.
///
/// All sums are zero if what they leave is no more than rounding. The result has the same bits on every run,
/// also with AVX-512 (`wide`).
SharedSums sharedVolume(const PlacedSurface& a, const PlacedSurface& b, bool wide = hasAvx512());

}  // namespace innersphere
