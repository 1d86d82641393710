// Reduces an overlap region to a few patches, from which contact points are made.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "innersphere/geometry.hpp"
#include "innersphere/overlap.hpp"

namespace innersphere {

/// Describes a part of an overlap region with one direction of contact. It has the frames of Overlap: vectors
/// have the axes of the world, points are relative to the origin of A.
struct Patch {
  double volume = 0;  ///< The volume [m^3].
  double area = 0;    ///< The length of the summed area vector [m^2].
  Vec3d normal{};     ///< The unit normal, from A to B.
  Vec3d centroid{};   ///< The area-weighted centroid [m].
  /// The area-weighted second central moment of position [m^2]: how far the patch extends.
  Mat3d covariance{};
  /// Returns the mean penetration depth, volume / area [m].
  double depth() const { return area > 0 ? volume / area : 0; }
};

/// Says how contacts are grouped into patches.
struct PatchOptions {
  /// The number of patches, 1 or more, that is not exceeded. Smaller ones are merged into neighbours.
  std::size_t max_patches = 4;
  /// The angle [rad], > 0, within which directions share a patch.
  double max_angle = 0.5;
};

/// Groups the contacts of one body's spheres by direction and place, and replaces `patches` by the result,
/// which is empty where nothing has a direction. Each sphere's vectors were summed over its partners first,
/// so spheres deep inside the other body weigh little. The result depends on nothing but the contacts and
/// their order. Throws Error bad_argument for options out of range.
void buildPatches(const SphereContact* contacts, std::size_t count, const PatchOptions& options,
                  std::vector<Patch>& patches);

}  // namespace innersphere
