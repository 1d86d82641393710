// Where sharp edges of two solids cross.
#pragma once

#include "narrow_phase/surface_probe.hpp"
#include "shape/sharp_edges.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// See Gauge::crossing(). Positions are relative to A's origin, axes of the world.
bool crossingEdges(const EdgedSolid& a, const EdgedSolid& b, const Gap& gap, const btVector3& direction,
                   Gauge::Corner& crossing);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
