// What SubstepSolver is told along with a contact point: how curved the bodies are there, and when that was.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Of the first and the second body of a manifold at a point [1/m], positive where convex, 0 where flat or
/// not known.
struct Curvatures {
  btScalar a = 0, b = 0;
};

/// A manifold point has no place for them. Where no one has set directions of friction, no one reads the
/// speeds along these.
inline bool hasRoomForCurvatures(const btManifoldPoint& point) {
  return (point.m_contactPointFlags & BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED) == 0;
}
inline void setCurvatures(btManifoldPoint& point, const Curvatures& curvatures) {
  if (!hasRoomForCurvatures(point)) return;
  point.m_contactMotion1 = curvatures.a;
  point.m_contactMotion2 = curvatures.b;
}
inline Curvatures curvaturesOf(const btManifoldPoint& point) {
  if (!hasRoomForCurvatures(point)) return {};
  return {point.m_contactMotion1, point.m_contactMotion2};
}

/// Bullet's own shapes touch where the bodies are: kinematic ones where the step ends, others where it
/// begins. A point with this flag, which Bullet has no use for, is of the beginning for both.
constexpr int kContactOfStart = 1 << 16;
inline bool isOfStart(const btManifoldPoint& point) {
  return (point.m_contactPointFlags & kContactOfStart) != 0;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
