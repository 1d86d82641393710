// From the contacts of single spheres to patches with points.
#pragma once

#include <vector>

#include "contact_patch.hpp"
#include "gauge.hpp"
#include "innersphere/overlap.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Replaces `patches`, which hold those of the step before. With a gauge, points are contacts of spheres
/// whose depth was measured on the solids' surfaces: the deepest and those that span the patch, the old ones
/// by preference. Without one, points are placed by the patch's moments, with the mean depth volume / area
/// and its slope. Points closer than `spacing` [m] to each other are one, and those further apart from the
/// other body than `spacing` are left out. `slack` is by how much the spheres of both bodies were enlarged.
/// `reference` are axes that turn with a body: points keep their places in them.
void buildContactPatches(const std::vector<SphereContact>& contacts, const Gauge* gauge, btScalar slack,
                         btScalar spacing, const btMatrix3x3& reference, std::vector<ContactPatch>& patches);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
