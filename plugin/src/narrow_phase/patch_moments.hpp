// Finds moments of a patch of contact, and the points that stand for them.
#pragma once

#include <vector>

#include <LinearMath/btMatrix3x3.h>

#include "innersphere/overlap.hpp"
#include "narrow_phase/contact_point.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Holds the moments of a patch. Area and normal are zero if the contacts push from all sides alike.
struct PatchMoments {
  btScalar volume = 0;        ///< [m^3]
  btScalar area = 0;          ///< length of the summed area vectors [m^2]
  btVector3 normal{0, 0, 0};  ///< unit, from A to B
  btVector3 centre{0, 0, 0};  ///< weighted by area [m]
  btScalar radius = 0;        ///< mean distance of the area from the centre [m]
  btVector3 tangent[2];       ///< with the normal a right-handed frame
  btScalar spread[3] = {};    ///< second central moment in the plane: 00, 01, 11 [m^2]
  btScalar slope[2] = {};     ///< of the depth along the tangents
};

/// Returns the moments of the contacts with the given indices. `reference` are axes that turn with a body:
/// tangents turn with it.
PatchMoments patchMoments(const std::vector<SphereContact>& contacts, const std::vector<std::size_t>& indices,
                          const btMatrix3x3& reference);

/// Makes up to four points at the corners of a rectangle with the spread of the patch (sqrt 3 standard
/// deviations), with depths that give the force and the torque of the volume. There are none if there is no
/// depth. Of points closer than `spacing` [m] to each other one is left.
void pointsFromMoments(const PatchMoments& moments, btScalar spacing, ContactPatch& patch);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
