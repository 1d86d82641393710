// The deepest points between curved surfaces.
#pragma once

#include <vector>

#include "contact_normal.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Spheres sample a contact at places of their own; where curved solids touch, the points that bear lie
/// between them: beside them a rolling body would brake. Moves each of `measured` uphill, by the slope of the
/// depth that the normals tell, and appends the deepest once more, with an id of its own.
void climb(const Gauge& gauge, std::vector<Measured>& measured);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
