// Bullet's vectors from doubles, in either precision, and back.
#pragma once

#include <btBulletDynamicsCommon.h>

#include "innersphere/geometry.hpp"

namespace innersphere::demo {

inline btVector3 vec(double x, double y, double z) {
  return {btScalar(x), btScalar(y), btScalar(z)};
}

inline Vec3d toVec3d(const btVector3& v) {
  return {double(v.x()), double(v.y()), double(v.z())};
}

/// Moved, not turned.
inline btTransform at(double x, double y, double z) {
  return btTransform(btQuaternion::getIdentity(), vec(x, y, z));
}

/// Turned by `angle` [rad] about an axis.
inline btQuaternion turn(const btVector3& axis, double angle) {
  return btQuaternion(axis.normalized(), btScalar(angle));
}

}  // namespace innersphere::demo
