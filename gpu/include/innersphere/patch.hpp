// An overlap region reduced to a few patches, from which contact points are made.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "innersphere/geometry.hpp"
#include "innersphere/overlap.hpp"

namespace innersphere {

/// A part of an overlap region with one direction of contact. It has the frames of Overlap: vectors have the
/// axes of the world, points are relative to the origin of A.
struct Patch {
  double volume = 0;   ///< The volume [m^3].
  double area = 0;     ///< The length of the summed area vector [m^2].
  Vec3d normal{};      ///< The unit normal, from A to B.
  Vec3d centroid{};    ///< The area-weighted centroid [m].
  Mat3d covariance{};  ///< The area-weighted second central moment of position [m^2]: how far the patch
                       ///< extends.
  /// Returns the mean penetration depth, volume / area [m].
  double depth() const { return area > 0 ? volume / area : 0; }
};

/// How contacts are grouped.
struct PatchOptions {
  std::size_t max_patches = 4;  ///< The number of patches, at most. Smaller ones are merged into neighbours.
  double max_angle = 0.5;       ///< The angle [rad] within which directions share a patch.
};

/// Groups the contacts of one body's spheres by direction and place. Each sphere's vectors were summed over
/// its partners first, so spheres deep inside the other body weigh little. The result depends on nothing but
/// the contacts and their order.
void buildPatches(const SphereContact* contacts, std::size_t count, const PatchOptions& options,
                  std::vector<Patch>& patches);

}  // namespace innersphere
