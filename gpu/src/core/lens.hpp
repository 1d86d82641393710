// The overlap of two balls: a lens.
#pragma once

#include <cmath>

#include "core/vec3.hpp"

namespace innersphere::core {

/// What one pair of overlapping balls contributes. All lengths to one unit.
template <typename T>
struct Lens {
  T volume;    ///< V
  T fraction;  ///< of the centroid's way from the centre of ball a to that of ball b, 0 to 1
  T rim_area;  ///< pi a^2 = -dV/dd, a the radius of the circle in which the two surfaces meet
};

namespace detail {

template <typename T>
constexpr T kPi = static_cast<T>(3.141592653589793238462643383279502884L);

/// d - |ra - rb|, from d or from the depth s, whichever rounds less: how far the smaller ball is from lying
/// inside.
template <typename T>
INNERSPHERE_HD inline T outside(T small, T step, T d, T s) {
  return d < small ? d - step : 2 * small - s;
}

/// (-ln(1 - x) - x - x^2/2 - x^3/3 - x^4/4) / x^3 for 0 < x < 1, y = 1 - x. Where x is small the logarithm
/// would cancel, and nine terms of the series are exact enough.
template <typename T>
INNERSPHERE_HD inline T logTail(T x, T y) {
  const T x2 = x * x;
  if (x > (sizeof(T) == sizeof(float) ? T(0.25) : T(0.0625))) {
    using std::log;
    return (-log(y) - x - x2 / 2 - x2 * x / 3 - x2 * x2 / 4) / (x2 * x);
  }
  T sum = T(1) / 13;
  for (int k = 12; k >= 5; --k) sum = sum * x + T(1) / T(k);
  return sum * x2;
}

}  // namespace detail

/// The lens of two balls with radii ra, rb whose centres are d apart and that reach s = ra + rb - d > 0 into
/// each other. s is an argument of its own because the caller can have it without the cancellation; every
/// term below is a sum or product of non-negative numbers, so results keep the relative accuracy of d and s,
/// also for s << r and ra << rb. Volume and centroid: the lens is a cap of height h (3 r - h) h^2 pi/3 from
/// each ball, and the first moments of the two caps about their own centres cancel, so V c = Va ca + Vb cb
/// with ca, cb the centres of the balls. A ball inside the other is its own lens; two balls with the same
/// centre and radius meet halfway.
template <typename T>
INNERSPHERE_HD inline Lens<T> lens(T ra, T rb, T d, T s) {
  const T pi = detail::kPi<T>;
  const T small = ra < rb ? ra : rb;
  const T large = ra < rb ? rb : ra;
  const T step = large - small;
  const T out = detail::outside(small, step, d, s);
  if (!(out > 0)) {
    const T fraction = ra > rb ? T(1) : ra < rb ? T(0) : T(0.5);
    return {pi * 4 / 3 * small * small * small, fraction, T(0)};
  }
  const T half = s / (2 * d);
  const T h_large = half * out;
  const T h_small = half * (d + step);
  const T v_large = h_large * h_large * (3 * large - h_large);
  const T v_small = h_small * h_small * (3 * small - h_small);
  const T volume = v_large + v_small;
  const T rim = half * (ra + rb + d) * out * ((d + step) / (2 * d));
  return {pi / 3 * volume, (ra < rb ? v_large : v_small) / volume, pi * rim};
}

/// The potential of the central force V: the integral of V over the distance, from d to ra + rb. With x = s /
/// R, R = ra + rb, D = ra - rb it is pi/12 R s^3 [4 ra rb / R^2 - (1 + 3 D^2 / R^2) x / 4 - 3 D^2 / R^2
/// tail(x)]: the closed form of V integrated and ordered so that little cancels. Inside the other ball V is
/// constant and U grows linearly.
template <typename T>
INNERSPHERE_HD inline T lensEnergy(T ra, T rb, T d, T s) {
  const T pi = detail::kPi<T>;
  const T small = ra < rb ? ra : rb;
  const T step = ra < rb ? rb - ra : ra - rb;
  const T sum = ra + rb;
  const T out = detail::outside(small, step, d, s);
  const T depth = out > 0 ? s : 2 * small;
  const T x = depth / sum;
  const T delta2 = step / sum * (step / sum);
  T u = 4 * (ra / sum) * (rb / sum) - (1 + 3 * delta2) / 4 * x;
  if (delta2 > 0) u -= 3 * delta2 * detail::logTail(x, (out > 0 ? d : step) / sum);
  u *= pi / 12 * sum * depth * depth * depth;
  return out > 0 ? u : u - pi * 4 / 3 * small * small * small * out;
}

}  // namespace innersphere::core
