// Where sharp edges of two solids cross.
#pragma once

#include "narrow_phase/surface_probe.hpp"
#include "shape/sharp_edges.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// See SurfaceProbe::crossing(). Positions are relative to A's origin, axes of the world.
bool crossingEdges(const SharpEdges& a, const SharpEdges& b, const OpposedPoints& gap,
                   const btVector3& direction, SurfaceProbe::Corner& crossing);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
