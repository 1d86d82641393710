// Declares small vectors and their arithmetic, on the CPU and in CUDA code.
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

/// Holds three numbers. It is an aggregate without initialisation: Vec3<T>{} is zero.
template <typename T>
struct Vec3 {
  T x;  ///< The first component.
  T y;  ///< The second component.
  T z;  ///< The third component.

  using value_type = T;  ///< The type of a component.
  using iterator = T*;  ///< The iterator goes through the components, which lie next to each other in memory.
  using const_iterator = const T*;  ///< The iterator of a constant vector.

  /// Returns the component number i, 0 to 2, unchecked.
  INNERSPHERE_HD T& operator[](std::size_t i) { return (&x)[i]; }
  /// Returns the component number i of a constant vector.
  INNERSPHERE_HD const T& operator[](std::size_t i) const { return (&x)[i]; }
  /// Returns a pointer to the components, which lie in a row.
  INNERSPHERE_HD T* data() { return &x; }
  /// Returns a pointer to the components of a constant vector.
  INNERSPHERE_HD const T* data() const { return &x; }
  /// Returns an iterator at the first component.
  INNERSPHERE_HD T* begin() { return &x; }
  /// Returns an iterator at the first component of a constant vector.
  INNERSPHERE_HD const T* begin() const { return &x; }
  /// Returns an iterator behind the last component.
  INNERSPHERE_HD T* end() { return &x + 3; }
  /// Returns an iterator behind the last component of a constant vector.
  INNERSPHERE_HD const T* end() const { return &x + 3; }
};
/// This is a vector in single precision.
using Vec3f = Vec3<float>;
/// This is a vector in double precision.
using Vec3d = Vec3<double>;
static_assert(sizeof(Vec3f) == 3 * sizeof(float) && sizeof(Vec3d) == 3 * sizeof(double));

/// Returns true if all components are equal.
template <typename T>
INNERSPHERE_HD inline bool operator==(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

/// Returns true if a component differs.
template <typename T>
INNERSPHERE_HD inline bool operator!=(const Vec3<T>& a, const Vec3<T>& b) {
  return !(a == b);
}

/// Returns the sum of two vectors.
template <typename T>
INNERSPHERE_HD inline Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

/// Returns the difference of two vectors.
template <typename T>
INNERSPHERE_HD inline Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

/// Returns the opposite vector.
template <typename T>
INNERSPHERE_HD inline Vec3<T> operator-(const Vec3<T>& a) {
  return {-a.x, -a.y, -a.z};
}

/// Returns the vector times a number.
template <typename T>
INNERSPHERE_HD inline Vec3<T> operator*(typename Vec3<T>::value_type s, const Vec3<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}

/// Returns the scalar product.
template <typename T>
INNERSPHERE_HD inline T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Returns the vector product.
template <typename T>
INNERSPHERE_HD inline Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Returns the length of a vector.
template <typename T>
INNERSPHERE_HD inline T norm(const Vec3<T>& a) {
  using std::sqrt;
  return sqrt(dot(a, a));
}

}  // namespace innersphere
