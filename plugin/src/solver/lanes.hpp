// Several scalars that are computed with at once: one for each of several pairs of bodies.
#pragma once

#include <cmath>
#include <utility>

#include <LinearMath/btVector3.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// As many as fit into 32 bytes: what processors with AVX2 add and multiply at once, and others in two
/// halves.
constexpr int kLanes = 32 / sizeof(btScalar);
using Lanes = btScalar __attribute__((vector_size(32), aligned(32)));

/// For a function that inlines all that it calls, compiled for such processors. No multiplication is fused
/// with an addition there either: the bits are the same.
#if defined(__x86_64__)
#define INNERSPHERE_WIDE __attribute__((target("avx2"), flatten))
inline bool hasWideLanes() {
  return __builtin_cpu_supports("avx2") != 0;
}
#else
#define INNERSPHERE_WIDE __attribute__((flatten))
inline bool hasWideLanes() {
  return false;
}
#endif

inline Lanes inAll(btScalar x) {
  return x - Lanes{};
}
inline Lanes larger(Lanes a, Lanes b) {
  return a > b ? a : b;
}
inline Lanes smaller(Lanes a, Lanes b) {
  return a < b ? a : b;
}
/// No further from 0 than `most`.
inline Lanes within(Lanes most, Lanes value) {
  return larger(Lanes{} - most, smaller(most, value));
}
inline Lanes root(Lanes a) {
  for (int lane = 0; lane < kLanes; ++lane) a[lane] = std::sqrt(a[lane]);
  return a;
}

/// Takes numbers of two rows: the places of b follow those of a.
#if defined(__has_builtin) && __has_builtin(__builtin_shufflevector)
#define INNERSPHERE_PICKED(a, b, place) __builtin_shufflevector(a, b, (place)...)
#else
#define INNERSPHERE_PICKED(a, b, place) \
  (Lanes{((place) < kLanes ? a[(place) % kLanes] : b[(place) % kLanes])...})
#endif

/// Exchanges numbers of two rows of a matrix whose numbers differ in this bit: those at places that have it
/// in a, and those at places that lack it in b.
template <int kBit, int... kPlaces>
void exchange(Lanes& a, Lanes& b, std::integer_sequence<int, kPlaces...>) {
  const Lanes first = INNERSPHERE_PICKED(a, b, (kPlaces & kBit) == 0 ? kPlaces : kLanes + (kPlaces ^ kBit));
  b = INNERSPHERE_PICKED(a, b, (kPlaces & kBit) == 0 ? kPlaces ^ kBit : kLanes + kPlaces);
  a = first;
}
#undef INNERSPHERE_PICKED

/// Makes rows of as many numbers the columns.
template <int kBit = kLanes / 2>
void transpose(Lanes* rows) {
  for (int row = 0; row < kLanes; ++row) {
    if ((row & kBit) == 0)
      exchange<kBit>(rows[row], rows[row + kBit], std::make_integer_sequence<int, kLanes>());
  }
  if constexpr (kBit > 1) transpose<kBit / 2>(rows);
}

/// A vector in each lane.
struct Lanes3 {
  Lanes x{}, y{}, z{};

  void set(int lane, const btVector3& v) {
    x[lane] = v.x();
    y[lane] = v.y();
    z[lane] = v.z();
  }
  btVector3 get(int lane) const { return btVector3(x[lane], y[lane], z[lane]); }
};

inline Lanes3 operator+(const Lanes3& a, const Lanes3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Lanes3 operator-(const Lanes3& a, const Lanes3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Lanes3 operator*(const Lanes3& a, Lanes s) {
  return {a.x * s, a.y * s, a.z * s};
}
/// Component by component.
inline Lanes3 scaled(const Lanes3& a, const Lanes3& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
inline Lanes dot(const Lanes3& a, const Lanes3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Lanes3 cross(const Lanes3& a, const Lanes3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
