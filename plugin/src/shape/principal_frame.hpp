// Finds the mass properties of a packed solid in the frame that Bullet's rigid bodies need.
#pragma once

#include <LinearMath/btTransform.h>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/packing.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

struct PrincipalFrame {
  btTransform from_packing;    ///< origin to the centre of mass, axes to the principal axes
  btVector3 moments{0, 0, 0};  ///< principal moments for unit mass [m^2]
};

/// Returns the frame by packing.solid or, if that has no volume (imported spheres), by the spheres at equal
/// density. Axes that are principal already, to within 1e-5, are kept, so that a box or a torus does not
/// turn.
PrincipalFrame principalFrame(const Packing& packing);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
