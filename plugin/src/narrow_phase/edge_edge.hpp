// Finds where sharp edges of two solids cross.
#pragma once

#include "narrow_phase/edge_contacts.hpp"
#include "shape/sharp_edges.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Does what EdgeProbe::crossing() says. Positions are relative to A's origin, axes are those of the world.
bool crossEdges(const SharpEdges& a, const SharpEdges& b, const OpposedPoints& points,
                const btVector3& direction, EdgeContact& crossing);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
