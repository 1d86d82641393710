// Computes the overlap of two balls, a lens. There are no branches, so that compilers can evaluate many of
// them side by side, and no operations but those that round alike everywhere, so that all processors give the
// same bits.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "innersphere/vec3.hpp"

namespace innersphere::core {

/// Describes two overlapping balls: their radii, the distance d of their centres, how far they reach into
/// each other, s = ra + rb - d >= 0, and 1 / d and 1 / (ra + rb), which the caller has anyway. s is given
/// because the caller can have it without the cancellation.
struct Balls {
  double ra, rb, d, s, inverse_d, inverse_sum;
};

/// Tells what one pair of overlapping balls contributes. All lengths have one unit.
struct Lens {
  double volume;    ///< V
  double moment;    ///< V times the centroid's way from the centre of ball a to that of ball b, 0 to 1
  double rim_area;  ///< pi a^2 = -dV/dd, a the radius of the circle in which the two surfaces meet
};

namespace detail {

constexpr double kPi = 3.141592653589793238462643383279502884;

/// Returns d - |ra - rb|, from d or from s, whichever rounds less: how far the smaller ball is from lying
/// inside.
INNERSPHERE_HD inline double outside(double small, double step, double d, double s) {
  const double from_d = d - step, from_s = 2 * small - s;
  return d < small ? from_d : from_s;
}

/// Returns the natural logarithm of 0 < x <= 1, to about 2e-16 of itself.
INNERSPHERE_HD inline double logarithm(double x) {
  // x = 2^k m with m from sqrt(1/2) to sqrt(2), and ln m = 2 artanh z.
  constexpr std::uint64_t kRootHalf = 0x3fe6a09e00000000u, kOne = 0x3ff0000000000000u;
  constexpr std::uint64_t kMantissa = 0x000fffffffffffffu, kTwo52 = 0x4330000000000000u;
  std::uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  bits += kOne - kRootHalf;
  const std::uint64_t exponent = bits >> 52 | kTwo52;
  bits = (bits & kMantissa) + kRootHalf;
  double k, m;
  memcpy(&k, &exponent, sizeof k);
  memcpy(&m, &bits, sizeof m);
  k -= 4503599627370496.0 + 1023;  // 2^52 and the bias of exponents
  const double z = (m - 1) / (m + 1), z2 = z * z;
  double sum = 1.0 / 21;
  for (int n = 19; n >= 3; n -= 2) sum = sum * z2 + 1.0 / n;
  return k * 0.693147180559945309417 + 2 * (z + z * z2 * sum);
}

/// Returns -ln(1 - x) - x - x^2/2 - x^3/3 - x^4/4 for 0 < x < 1, y = 1 - x. Where x is small the logarithm
/// would cancel, and nine terms of the series are exact enough.
INNERSPHERE_HD inline double logTail(double x, double y) {
  const double x2 = x * x;
  double series = 1.0 / 13;
  for (int n = 12; n >= 5; --n) series = series * x + 1.0 / n;
  series *= x2 * x2 * x;
  const double closed = -logarithm(y) - x * (1 + x * (1.0 / 2 + x * (1.0 / 3 + x * (1.0 / 4))));
  return x > 0.0625 ? closed : series;
}

}  // namespace detail

/// Returns the lens of two balls. Every term below is a sum or product of non-negative numbers, so results
/// keep the relative accuracy of d and s, also for s << r and ra << rb. Volume and centroid: the lens is a
/// cap of height h (3 r - h) h^2 pi/3 from each ball, and the first moments of the two caps about their own
/// centres cancel, so V c = Va ca + Vb cb with ca, cb the centres of the balls. A ball inside the other is
/// its own lens; two balls with the same centre and radius meet halfway.
INNERSPHERE_HD inline Lens lens(const Balls& b) {
  constexpr double kPi = detail::kPi;
  const double small = b.ra < b.rb ? b.ra : b.rb;
  const double large = b.ra < b.rb ? b.rb : b.ra;
  const double step = large - small;
  const double out = detail::outside(small, step, b.d, b.s);
  const double half = 0.5 * b.s * b.inverse_d;
  const double h_large = half * out;
  const double h_small = half * (b.d + step);
  const double v_large = kPi / 3 * (h_large * h_large * (3 * large - h_large));
  const double v_small = kPi / 3 * (h_small * h_small * (3 * small - h_small));
  const double rim = kPi * (half * (b.ra + b.rb + b.d) * out * ((b.d + step) * (0.5 * b.inverse_d)));
  const double ball = kPi * 4 / 3 * small * small * small;
  const double ball_moment = b.ra > b.rb ? ball : b.ra < b.rb ? 0.0 : 0.5 * ball;
  const double moment = b.ra < b.rb ? v_large : v_small;
  const bool apart = out > 0;
  return {apart ? v_large + v_small : ball, apart ? moment : ball_moment, apart ? rim : 0.0};
}

/// Returns the potential of the central force V: the integral of V over the distance, from d to ra + rb. With
/// x = s / R, R = ra + rb, D = ra - rb it is pi/12 R [s^3 (4 ra rb / R^2 - (1 + 3 D^2 / R^2) x / 4) - 3 D^2 R
/// logTail(x)]: the closed form of V integrated and ordered so that little cancels. Inside the other ball V
/// is constant and U grows linearly.
INNERSPHERE_HD inline double lensEnergy(const Balls& b) {
  constexpr double kPi = detail::kPi;
  const double small = b.ra < b.rb ? b.ra : b.rb;
  const double large = b.ra < b.rb ? b.rb : b.ra;
  const double step = large - small;
  const double sum = b.ra + b.rb;
  const double out = detail::outside(small, step, b.d, b.s);
  const bool apart = out > 0;
  const double depth = apart ? b.s : 2 * small;
  const double x = depth * b.inverse_sum;
  const double left = (apart ? b.d : step) * b.inverse_sum;
  constexpr double kTiny = 1e-300;  // has a logarithm; its factor is then zero
  const double y = left > kTiny ? left : kTiny;
  const double delta = step * b.inverse_sum, delta2 = delta * delta;
  const double u = 4 * (b.ra * b.inverse_sum) * (b.rb * b.inverse_sum) - (1 + 3 * delta2) / 4 * x;
  const double tail = 3 * delta2 * detail::logTail(x, y);
  const double cube = kPi / 12 * sum * (sum * sum * sum);
  const double energy = cube * (x * x * x * u - tail);
  const double ball = kPi * 4 / 3 * small * small * small;
  return apart ? energy : energy - ball * out;
}

}  // namespace innersphere::core
