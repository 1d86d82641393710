// Sums of real numbers that do not depend on the order of their terms.
//
// Floating-point addition is not associative, so a sum over pairs found by many threads would change from run
// to run. Each term is therefore rounded once, to a multiple of a quantum that depends on the query alone,
// and added as a 128-bit integer. Integer sums have the same bits in any order, and negated terms give
// exactly the negated sum.
#pragma once

#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/vec3.hpp"

namespace innersphere::core {

/// A 128-bit two's complement integer in units of 2^-shift, where `shift` is kept beside it.
struct FixedSum {
  unsigned long long lo;
  unsigned long long hi;
};

INNERSPHERE_HD inline FixedSum operator+(const FixedSum& a, const FixedSum& b) {
  const unsigned long long lo = a.lo + b.lo;
  return {lo, a.hi + b.hi + (lo < a.lo ? 1u : 0u)};
}

INNERSPHERE_HD inline FixedSum operator-(const FixedSum& a) {
  return {~a.lo + 1u, ~a.hi + (a.lo == 0 ? 1u : 0u)};
}

/// Terms are below 2^(kFixedBits - shift), and so is the magnitude of their sum.
constexpr int kFixedBits = 124;

/// x in units of 2^-shift, rounded towards zero, so that toFixed(-x) = -toFixed(x).
INNERSPHERE_HD inline FixedSum toFixed(double x, int shift) {
  std::uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  const int exponent = static_cast<int>(bits >> 52 & 0x7ff);
  if (exponent == 0) return {0, 0};  // zero; a subnormal number is below every quantum that a query may have
  const std::uint64_t mantissa = (bits & 0xfffffffffffffu) | 0x10000000000000u;
  const int up = exponent - 1075 + shift;
  assert(up + 53 <= kFixedBits + 1);
  FixedSum sum{0, 0};
  if (up >= 64) {
    sum.hi = mantissa << (up - 64);
  } else if (up > 0) {
    sum.lo = mantissa << up;
    sum.hi = mantissa >> (64 - up);
  } else if (up > -53) {
    sum.lo = mantissa >> -up;
  }
  return bits >> 63 ? -sum : sum;
}

inline double toDouble(const FixedSum& sum, int shift) {
  const bool negative = sum.hi >> 63;
  const FixedSum size = negative ? -sum : sum;
  const double x = std::ldexp(static_cast<double>(size.hi), 64) + static_cast<double>(size.lo);
  return std::ldexp(negative ? -x : x, -shift);
}

}  // namespace innersphere::core
