// Small vectors for code that runs on the CPU and on the device.
#pragma once

#if defined(__CUDACC__)
#define INNERSPHERE_HD __host__ __device__
#else
#define INNERSPHERE_HD
#endif

namespace innersphere::core {

template <typename T>
struct Vec3 {
  T x, y, z;
};
using Vec3f = Vec3<float>;
using Vec3r = Vec3<double>;

template <typename T>
INNERSPHERE_HD inline Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <typename T>
INNERSPHERE_HD inline Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <typename T>
INNERSPHERE_HD inline Vec3<T> operator*(T s, const Vec3<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}

template <typename T>
INNERSPHERE_HD inline T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <typename T>
INNERSPHERE_HD inline Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Row-major 3x3 matrix.
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
