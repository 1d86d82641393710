// Two places at which bodies are in each other, and which drive them apart in different ways.
#pragma once

#include <LinearMath/btMinMax.h>
#include <LinearMath/btVector3.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// What two places of a pair press against each other is no load, and a solid would be too stiff for a depth
/// that is seen. So what was driven in as a wedge comes out, though friction would hold it.
struct Squeeze {
  /// Returns the share of the friction that is left at a depth of more than `unseen`, which is not seen yet:
  /// it falls with the square, so that a slender wedge comes out nearly as far as a blunt one.
  static btScalar friction(btScalar depth, btScalar unseen) { return unseen * unseen / (depth * depth); }
  /// Returns the share of the push that is left at a place, in view of another one, with their depths and
  /// normals; 1 if they do not press against each other. Along both, bodies come out no faster than along
  /// one: that is the sine of half of the angle between them.
  static btScalar push(btScalar depth, const btVector3& normal, btScalar other_depth,
                       const btVector3& other_normal) {
    if (!(other_depth > 0) || !(normal.dot(other_normal) < 0)) return 1;
    const btScalar squeezed = btMin(btScalar(1), other_depth / depth);
    return 1 - squeezed * (1 - (normal + other_normal).length() / 2);
  }
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
