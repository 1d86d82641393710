// Finds the way out for two bodies that are deep in each other.
#pragma once

#include <vector>

#include "narrow_phase/contact_samples.hpp"
#include "narrow_phase/packing_probe.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Two packings, and their spheres that overlap.
struct OverlappingPackings {
  const PlacedPacking& a;
  const PlacedPacking& b;
  const std::vector<SphereContact>& contacts;
  const ContactSpheres& spheres;  ///< of these
};

/// Replaces `found` by points of the shortest of several ways by which A leaves B, one on each of some lines
/// through the overlap. Along a line both solids are apart once A has gone from where the line enters B to
/// where it leaves A; a way is as long as its longest line, or as it takes A's spheres to be clear of B's.
/// Ways that are tried: those of `patches`, the axes of both bodies, from the middle of the overlap to the
/// nearest surface of each, from the centre of the one to that of the other, and where the volume of overlap
/// falls fastest. `before`: the way of the last search with its length [m], which bodies stay on while it
/// becomes shorter, or 0. None is found where lines meet no surface.
void findWayOut(const OverlappingPackings& packings, const std::vector<ContactPatch>& patches,
                const btVector3& before, std::vector<WeightedPoint>& found);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
