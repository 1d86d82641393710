// From the contacts of single spheres to patches with points.
#pragma once

#include <vector>

#include "contact_patch.hpp"
#include "gauge.hpp"
#include "innersphere/overlap.hpp"
#include "measure.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Replaces `patches`, which hold those of the step before. Where surfaces are measured, points are contacts
/// of spheres: the deepest and those that span the patch, the old ones by preference. Else points are placed
/// by the patch's moments, with the mean depth volume / area and its slope. `reference` are axes that turn
/// with a body: points keep their places in them.
void buildContactPatches(const std::vector<SphereContact>& contacts, const Gauge& gauge,
                         const Measure& measure, const btMatrix3x3& reference,
                         std::vector<ContactPatch>& patches);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
