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

/// Whether surfaces that touch are flat, or curved so that one lies in the other: their curvatures add up to
/// nothing, or to a small part of themselves. Then there is no deepest point to speak of.
bool fitTogether(btScalar curvature_a, btScalar curvature_b);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
