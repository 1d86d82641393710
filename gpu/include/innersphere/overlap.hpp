// What a query returns.
#pragma once

#include <cstdint>
#include <vector>

#include "innersphere/geometry.hpp"

namespace innersphere {

/// The overlap of two packings A and B, summed over all pairs of overlapping spheres (lenses). Vectors have
/// the axes of the world. Points are relative to the origin of A (the translation of its placement), so that
/// they keep their digits far from the origin of the world. n is the unit vector from the centre of A's
/// sphere to the centre of B's: forces push B away, A gets the opposite.
struct Overlap {
  double volume = 0;  ///< sum of lens volumes V [m^3]
  Vec3d centroid{};   ///< of the lenses, volume-weighted [m]; zero when nothing overlaps
  Vec3d force{};      ///< sum V n [m^3]: the paper's penalty force on B for unit stiffness
  Vec3d torque{};     ///< of that force on B about the origin of B [m^4]
  Vec3d area{};  ///< sum pi a^2 n [m^2], a the radius of the lens' rim: minus the gradient of the volume with
                 ///< respect to the position of B, so it points along the contact normal and its length is
                 ///< the area of the contact
  double stiffness = 0;          ///< sum pi a^2 [m^2]: how fast the volume force grows with depth
  double energy = 0;             ///< potential of `force` for unit stiffness [m^4]
  std::uint64_t pair_count = 0;  ///< overlapping sphere pairs
};

/// A pair of overlapping spheres; indices into the two packings.
struct SpherePair {
  std::uint32_t a = 0;  ///< sphere of A
  std::uint32_t b = 0;  ///< sphere of B
};

/// One sphere's share of an overlap, summed over all its partners in the other body. Same frames as Overlap.
struct SphereContact {
  std::uint32_t sphere = 0;         ///< index into its packing
  float volume = 0;                 ///< [m^3]
  std::array<float, 3> centroid{};  ///< of its lenses [m]
  std::array<float, 3> area{};      ///< sum pi a^2 n [m^2], n always from A to B
};

}  // namespace innersphere
