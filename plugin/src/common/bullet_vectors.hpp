// Converts between the plain arrays of the query and Bullet's vectors.
#pragma once

#include <cmath>

#include <LinearMath/btTransform.h>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/geometry.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

template <typename T>
btVector3 toBullet(const std::array<T, 3>& v) {
  return btVector3(btScalar(v[0]), btScalar(v[1]), btScalar(v[2]));
}

template <typename T>
btVector3 toBullet(const Vec3<T>& v) {
  return btVector3(btScalar(v.x), btScalar(v.y), btScalar(v.z));
}

inline btVector3 centre(const Sphere& s) {
  return btVector3(s.x, s.y, s.z);
}

inline std::array<float, 3> toFloats(const btVector3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

inline Vec3d toDoubles(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

inline bool isFinite(const btVector3& v) {
  return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

inline bool isFinite(const btTransform& t) {
  const btMatrix3x3& m = t.getBasis();
  return isFinite(t.getOrigin()) && isFinite(m[0]) && isFinite(m[1]) && isFinite(m[2]);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
