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
  T x;  ///< The first component.
  T y;  ///< The second component.
  T z;  ///< The third component.

  using value_type = T;             ///< The type of a component.
  using iterator = T*;              ///< Goes through the components, which lie next to each other in memory.
  using const_iterator = const T*;  ///< The same for a constant vector.

  /// The component number i, 0 to 2.
  INNERSPHERE_HD T& operator[](std::size_t i) { return (&x)[i]; }
  /// The same for a constant vector.
  INNERSPHERE_HD const T& operator[](std::size_t i) const { return (&x)[i]; }
  /// The components in a row.
  INNERSPHERE_HD T* data() { return &x; }
  /// The components of a constant vector in a row.
  INNERSPHERE_HD const T* data() const { return &x; }
  /// The first component.
  INNERSPHERE_HD T* begin() { return &x; }
  /// The first component of a constant vector.
  INNERSPHERE_HD const T* begin() const { return &x; }
  /// Behind the last component.
  INNERSPHERE_HD T* end() { return &x + 3; }
  /// Behind the last component of a constant vector.
  INNERSPHERE_HD const T* end() const { return &x + 3; }
};
/// A vector in single precision.
using Vec3f = Vec3<float>;
/// A vector in double precision.
using Vec3d = Vec3<double>;
static_assert(sizeof(Vec3f) == 3 * sizeof(float) && sizeof(Vec3d) == 3 * sizeof(double));

/// Whether all components are equal.
template <typename T>
INNERSPHERE_HD inline bool operator==(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

/// Whether a component differs.
template <typename T>
INNERSPHERE_HD inline bool operator!=(const Vec3<T>& a, const Vec3<T>& b) {
  return !(a == b);
}

/// The sum of two vectors.
template <typename T>
INNERSPHERE_HD inline Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

/// The difference of two vectors.
template <typename T>
INNERSPHERE_HD inline Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

/// The opposite vector.
template <typename T>
INNERSPHERE_HD inline Vec3<T> operator-(const Vec3<T>& a) {
  return {-a.x, -a.y, -a.z};
}

/// A vector times a number.
template <typename T>
INNERSPHERE_HD inline Vec3<T> operator*(typename Vec3<T>::value_type s, const Vec3<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}

/// The scalar product.
template <typename T>
INNERSPHERE_HD inline T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// The vector product.
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
