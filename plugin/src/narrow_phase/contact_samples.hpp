// Contacts of a patch, measured on the solids' surfaces.
#pragma once

#include <vector>

#include "narrow_phase/contact_point.hpp"
#include "narrow_phase/sample_selection.hpp"
#include "narrow_phase/surface_probe.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// A point and the part of a patch of spheres that it stands for.
struct WeightedPoint {
  /// What it is measured between.
  enum class Kind {
    faces,
    edge,      ///< and a face, somewhere along it
    corner,    ///< of the one, over a face of the other, where the one reaches furthest
    crossing,  ///< of two edges
  };
  ContactPoint point;
  Kind kind;
  btScalar area;     ///< its share [m^2]
  btVector3 centre;  ///< of the patch
  btScalar radius;   ///< mean distance of the patch's area from there [m]
};

/// Appends those contacts of the samples' patch `p` that are on, or near, both surfaces: not further apart
/// than `separation` [m]. Leaves the lines that they were measured along in the samples.
void findContactPoints(Samples& samples, std::size_t p, const SurfaceProbe& probe, btScalar separation,
                       std::vector<WeightedPoint>& found);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
