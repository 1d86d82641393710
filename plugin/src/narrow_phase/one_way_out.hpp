// Lets what is through a thin shape leave it by one side.
#pragma once

#include <vector>

#include "narrow_phase/contact_point.hpp"
#include "narrow_phase/shapes/shape_surface.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Lists for each sphere of `body` that of its near spheres which is nearest to the other surface, or null.
void findNearestOfEach(const PlacedPacking& body, const std::vector<NearSphere>& near_spheres,
                       std::vector<const NearSphere*>& nearest);

/// Near spheres beyond the middle of a plate see its far face, and those before it its near one: both would
/// push, against each other, and hold what is through it. Where a sphere with its centre in the plate reaches
/// the middle, or a feeler beside it is beyond, all that hang together with it see one face: that which
/// `before`, the patches of the last step, were on; without them, or where they were on both, the one that
/// the centre of mass of `body` is on. `gap` [m] is how far apart the surfaces of spheres may be that hang
/// together. `plate` is placed at `world`; a shape that does not know depthOf() is left as it is.
void leaveByOneSide(const PlacedPacking& body, ShapeSurface& plate, const btTransform& world,
                    const std::vector<ContactPatch>& before, btScalar gap,
                    std::vector<NearSphere>& near_spheres);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
