// An overlap region reduced to a few patches, from which contact points are made.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "innersphere/geometry.hpp"
#include "innersphere/overlap.hpp"

namespace innersphere {

/// A part of an overlap region with one direction of contact. Same frames as Overlap: world axes, points
/// relative to the origin of A.
struct Patch {
  double volume = 0;   ///< [m^3]
  double area = 0;     ///< [m^2], the length of the summed area vector
  Vec3d normal{};      ///< unit, from A to B
  Vec3d centroid{};    ///< area-weighted [m]
  Mat3d covariance{};  ///< area-weighted second central moment of position [m^2]: how far the patch extends
  /// Mean penetration depth V / area [m].
  double depth() const { return area > 0 ? volume / area : 0; }
};

/// How contacts are grouped.
struct PatchOptions {
  std::size_t max_patches = 4;  ///< smaller ones are merged into their nearest neighbour
  double max_angle = 0.5;       ///< [rad] directions closer than this share a patch
};

/// Groups the contacts of one body's spheres by direction and place. Each sphere's vectors were summed over
/// its partners first, so spheres deep inside the other body weigh little. Deterministic: depends only on the
/// order of `contacts`.
void buildPatches(const SphereContact* contacts, std::size_t count, const PatchOptions& options,
                  std::vector<Patch>& patches);

}  // namespace innersphere
