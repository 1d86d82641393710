// Declares what a query returns.
#pragma once

#include <cstdint>
#include <vector>

#include "innersphere/geometry.hpp"

namespace innersphere {

/// Holds the overlap of two packings A and B, summed over all pairs of overlapping spheres. Two overlapping
/// spheres share a lens of volume V. Vectors have the axes of the world. Points are relative to the origin of
/// A, which is the translation of its placement, so that they keep their digits far from the origin of the
/// world. n is the unit vector from the centre of A's sphere to the centre of B's. Forces push B away; A gets
/// the opposite.
///
/// Volume-true spheres of one body overlap each other a little. Where a body lies nearly upon its copy they
/// meet themselves, and their lenses sum up to a tenth to a quarter more than there is. `volume` ends at what
/// the smaller solid has; everything else stays that of the lenses.
struct Overlap {
  /// The sum of V [m^3]; with volume-true radii at most Packing::solid.volume of the smaller body. A body
  /// whose solid is not known, that is grown by a margin or was changed by CollisionModel::update() sets no
  /// limit.
  double volume = 0;
  Vec3d centroid{};  ///< The volume-weighted centroid of the lenses [m]. Zero when nothing overlaps.
  Vec3d force{};     ///< The sum of V n [m^3]: the penalty force on B for unit stiffness.
  Vec3d torque{};    ///< The torque of that force on B about the origin of B [m^4].
  /// The sum of pi a^2 n [m^2], where a is the radius of the lens' rim. It is minus the gradient of the
  /// sum of V with respect to the position of B. So it points along the contact normal, and its length is the
  /// contact's area.
  Vec3d area{};
  double stiffness = 0;  ///< The sum of pi a^2 [m^2]: how fast the force grows with depth.
  double energy = 0;     ///< The potential of `force` for unit stiffness [m^4].
  /// The number of overlapping pairs of spheres; with Estimator::surface, of pairs of triangles that meet.
  std::uint64_t pair_count = 0;
};

/// Names a pair of overlapping spheres, as indices into the two packings.
struct SpherePair {
  std::uint32_t a = 0;  ///< The index of the sphere of A.
  std::uint32_t b = 0;  ///< The index of the sphere of B.
};

/// Tells what one sphere contributes to an overlap, summed over all its partners in the other body. It has
/// the frames of Overlap.
struct SphereContact {
  std::uint32_t sphere = 0;         ///< The index of the sphere in its packing.
  float volume = 0;                 ///< The volume of its lenses [m^3].
  std::array<float, 3> centroid{};  ///< The centroid of its lenses [m].
  std::array<float, 3> area{};      ///< The sum of pi a^2 n [m^2], n always from A to B.
};

}  // namespace innersphere
