// Finds where sharp edges of two solids cross.
#pragma once

#include "common/contact_tolerances.hpp"
#include "narrow_phase/edge_contacts.hpp"
#include "shape/sharp_edges.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Does what EdgeProbe::crossing() says. Positions are relative to A's origin, axes are those of the world.
/// Faces fall away from edges that cross by `falling` at least [sine].
bool crossEdges(const SharpEdges& a, const SharpEdges& b, const OpposedPoints& points,
                const btVector3& direction, EdgeContact& crossing, btScalar falling = kFallingSine);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
