// What SubstepSolver is told along with a contact point: how curved the bodies are there, and when that was.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>

#include "innersphere/bullet_precision.hpp"
#include "narrow_phase/hill.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Bullet's own shapes touch where the bodies are: kinematic ones where the step ends, others where it
/// begins. A point with this flag, which Bullet has no use for, is of the beginning for both, and knows how
/// the bodies bend.
constexpr int kContactOfStart = 1 << 16;
inline bool isOfStart(const btManifoldPoint& point) {
  return (point.m_contactPointFlags & kContactOfStart) != 0;
}

/// Of the first and the second body of a manifold at a point, in the axes across the normal out of the first
/// one.
struct PointBends {
  Bend a, b;
};

/// A manifold point has no place for them. They go where no one reads where no one has set directions of
/// friction: into the speeds along these, the softness of an anchor, and the fourth numbers of vectors.
inline bool hasRoomForBends(const btManifoldPoint& point) {
  return (point.m_contactPointFlags & BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED) == 0;
}
inline void setBends(btManifoldPoint& point, const PointBends& bends) {
  point.m_contactPointFlags |= kContactOfStart;
  if (!hasRoomForBends(point)) return;
  point.m_contactMotion1 = bends.a.xx;
  point.m_contactMotion2 = bends.a.xy;
  point.m_frictionCFM = bends.a.yy;
  point.m_normalWorldOnB[3] = bends.b.xx;
  point.m_lateralFrictionDir1[3] = bends.b.xy;
  point.m_lateralFrictionDir2[3] = bends.b.yy;
}
inline PointBends bendsOf(const btManifoldPoint& point) {
  if (!isOfStart(point) || !hasRoomForBends(point)) return {};
  return {{point.m_contactMotion1, point.m_contactMotion2, point.m_frictionCFM},
          {point.m_normalWorldOnB[3], point.m_lateralFrictionDir1[3], point.m_lateralFrictionDir2[3]}};
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
