// Finds where sharp edges of two solids cross.
#pragma once

#include <functional>

#include "narrow_phase/edge_contacts.hpp"
#include "shape/sharp_edges.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Returns true if a solid is thin. Only faces that fall away from their edge by little ask for it.
using IsThin = std::function<bool()>;

/// Does what EdgeProbe::crossing() says. Positions are relative to A's origin, axes are those of the world.
bool crossEdges(const SharpEdges& a, const SharpEdges& b, const OpposedPoints& points,
                const btVector3& direction, EdgeContact& crossing, const IsThin& is_thin = {});

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
