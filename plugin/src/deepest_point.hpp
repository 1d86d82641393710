// The deepest point between two curved surfaces.
#pragma once

#include <vector>

#include "contact_normal.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Spheres sample a contact at places of their own; where curved solids touch, the deepest point lies between
/// them. Climbs there from the deepest of `measured`, by the slope of the depth that the normals tell, and
/// appends what it finds.
void appendDeepest(const Gauge& gauge, std::vector<Measured>& measured);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
