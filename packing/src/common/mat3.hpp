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

template <typename T>
INNERSPHERE_HD inline Mat3<T> transposed(const Mat3<T>& a) {
  return {{a.m[0], a.m[3], a.m[6], a.m[1], a.m[4], a.m[7], a.m[2], a.m[5], a.m[8]}};
}

template <typename T>
INNERSPHERE_HD inline Mat3<T> product(const Mat3<T>& a, const Mat3<T>& b) {
  Mat3<T> c;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      c.m[3 * i + j] = a.m[3 * i] * b.m[j] + a.m[3 * i + 1] * b.m[3 + j] + a.m[3 * i + 2] * b.m[6 + j];
  }
  return c;
}

template <typename T>
INNERSPHERE_HD inline Mat3<T> scaled(const Mat3<T>& a, T s) {
  Mat3<T> b;
  for (int i = 0; i < 9; ++i) b.m[i] = s * a.m[i];
  return b;
}

}  // namespace innersphere::core
