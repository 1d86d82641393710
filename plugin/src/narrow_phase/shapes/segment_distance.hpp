// Distance from a thickened segment of the y axis or a point: spheres and capsules.
#pragma once

#include <LinearMath/btVector3.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Signed distance of a point at `offset` from the nearest point of the core, which is thickened by `radius`;
/// `normal` is the outward direction, `fallback` where the point lies on the core.
inline btScalar thickenedDistance(const btVector3& offset, btScalar radius, const btVector3& fallback,
                                  btVector3& normal) {
  const btScalar length = offset.length();
  normal = length > SIMD_EPSILON * radius ? offset / length : fallback;
  return length - radius;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
