// Small vectors and their arithmetic, on the CPU and in CUDA code.
#pragma once

#include <cmath>
#include <cstddef>

/// Marks functions that CUDA compiles for the host and for the device.
#if defined(__CUDACC__)
#define INNERSPHERE_HD __host__ __device__
#else
#define INNERSPHERE_HD
#endif

namespace innersphere {

/// A vector of three numbers. An aggregate without initialisation: Vec3<T>{} is zero.
template <typename T>
struct Vec3 {
  T x, y, z;

  using value_type = T;
  using iterator = T*;
  using const_iterator = const T*;

  /// The components by number, 0 to 2, and in a row. They lie next to each other in memory.
  INNERSPHERE_HD T& operator[](std::size_t i) { return (&x)[i]; }
  INNERSPHERE_HD const T& operator[](std::size_t i) const { return (&x)[i]; }
  INNERSPHERE_HD T* data() { return &x; }
  INNERSPHERE_HD const T* data() const { return &x; }
  INNERSPHERE_HD T* begin() { return &x; }
  INNERSPHERE_HD const T* begin() const { return &x; }
  INNERSPHERE_HD T* end() { return &x + 3; }
  INNERSPHERE_HD const T* end() const { return &x + 3; }
};
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;
static_assert(sizeof(Vec3f) == 3 * sizeof(float) && sizeof(Vec3d) == 3 * sizeof(double));

template <typename T>
INNERSPHERE_HD inline bool operator==(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

template <typename T>
INNERSPHERE_HD inline bool operator!=(const Vec3<T>& a, const Vec3<T>& b) {
  return !(a == b);
}

template <typename T>
INNERSPHERE_HD inline Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <typename T>
INNERSPHERE_HD inline Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <typename T>
INNERSPHERE_HD inline Vec3<T> operator-(const Vec3<T>& a) {
  return {-a.x, -a.y, -a.z};
}

template <typename T>
INNERSPHERE_HD inline Vec3<T> operator*(typename Vec3<T>::value_type s, const Vec3<T>& a) {
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

/// The length of a vector.
template <typename T>
INNERSPHERE_HD inline T norm(const Vec3<T>& a) {
  using std::sqrt;
  return sqrt(dot(a, a));
}

}  // namespace innersphere
