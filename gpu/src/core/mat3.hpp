// Declares 3x3 matrices for code that runs on the CPU and on the device.
#pragma once

#include "innersphere/vec3.hpp"

namespace innersphere::core {

/// This is a row-major 3x3 matrix.
template <typename T>
struct Mat3 {
  T m[9];
};

template <typename T>
INNERSPHERE_HD inline Vec3<T> operator*(const Mat3<T>& a, const Vec3<T>& v) {
  return {a.m[0] * v.x + a.m[1] * v.y + a.m[2] * v.z, a.m[3] * v.x + a.m[4] * v.y + a.m[5] * v.z,
          a.m[6] * v.x + a.m[7] * v.y + a.m[8] * v.z};
}

}  // namespace innersphere::core
