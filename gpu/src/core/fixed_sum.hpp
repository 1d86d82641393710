// Sums real numbers in a way that does not depend on the order of their terms.
//
// Floating-point addition is not associative, so a sum over pairs found by many threads would change from run
// to run. Each term is therefore rounded once, to a multiple of a quantum that depends on the query alone,
// and added as an integer. Integer sums have the same bits in any order, and negated terms give exactly the
// negated sum.
//
// A term is split into two integers, a coarse and a fine part, by adding and subtracting a large number: that
// is a few operations that any processor does on many terms side by side. Short sums of each part fit 64
// bits; long ones are kept in 128.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "innersphere/vec3.hpp"

namespace innersphere::core {

/// This is a 128-bit two's complement integer.
struct FixedSum {
  std::uint64_t lo;
  std::uint64_t hi;
};

INNERSPHERE_HD inline FixedSum operator+(const FixedSum& a, const FixedSum& b) {
  const std::uint64_t lo = a.lo + b.lo;
  return {lo, a.hi + b.hi + (lo < a.lo ? 1u : 0u)};
}

INNERSPHERE_HD inline FixedSum operator-(const FixedSum& a) {
  return {~a.lo + 1u, ~a.hi + (a.lo == 0 ? 1u : 0u)};
}

/// Returns x 2^shift, 0 <= shift < 64.
INNERSPHERE_HD inline FixedSum shifted(std::int64_t x, int shift) {
  const auto bits = static_cast<std::uint64_t>(x);
  const auto sign = static_cast<std::uint64_t>(x >> 63);
  if (shift == 0) return {bits, sign};
  return {bits << shift, sign << shift | bits >> (64 - shift)};
}

/// Says how one kind of term is rounded: its quantum is 2^-(coarse_shift + fine_bits). Terms are below
/// 2^(kCoarseBits - coarse_shift).
struct Unit {
  double coarse;  ///< 1.5 * 2^(52 - coarse_shift): the last bits of what is added to it are a coarse part
  double fine;    ///< The same for a fine part.
  int coarse_shift;
  int fine_bits;
};

/// Equals std::ldexp(1, exponent), where that is a normal number.
INNERSPHERE_HD inline double doublePowerOfTwo(int exponent) {
  constexpr int kBias = 1023, kMantissaBits = 52;
  const std::uint64_t bits = static_cast<std::uint64_t>(exponent + kBias) << kMantissaBits;
  double x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

INNERSPHERE_HD inline Unit unitWith(int coarse_shift, int fine_bits) {
  return {1.5 * doublePowerOfTwo(52 - coarse_shift), 1.5 * doublePowerOfTwo(52 - coarse_shift - fine_bits),
          coarse_shift, fine_bits};
}

constexpr int kCoarseBits = 49;    ///< of a term's coarse part
constexpr int kFineBits = 40;      ///< at most, of its fine part
constexpr int kFixedBits = 124;    ///< of a whole sum
constexpr int kShortSumBits = 13;  ///< so many terms, as a power of two, may be summed in 64 bits

/// Holds a sum of at most 2^kShortSumBits terms.
struct ShortSum {
  std::uint64_t coarse;
  std::uint64_t fine;
};

INNERSPHERE_HD inline std::uint64_t bitsOf(double x) {
  std::uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}

/// Holds the two parts of a term, rounded to nearest, ties to even, so that a term and its negation cancel:
/// what their bits are above those of the unit's numbers.
struct Parts {
  double coarse, fine;
};

INNERSPHERE_HD inline Parts split(double x, const Unit& unit) {
  const double coarse = x + unit.coarse;
  return {coarse, (x - (coarse - unit.coarse)) + unit.fine};
}

/// Adds the bits of a term's parts as they are: withoutUnit() makes it the sum.
INNERSPHERE_HD inline void addBits(ShortSum& sum, double x, const Unit& unit) {
  const Parts parts = split(x, unit);
  sum.coarse += bitsOf(parts.coarse);
  sum.fine += bitsOf(parts.fine);
}

/// Makes a sum of the bits of `terms` terms their sum.
INNERSPHERE_HD inline ShortSum withoutUnit(const ShortSum& sum, std::uint64_t terms, const Unit& unit) {
  return {sum.coarse - terms * bitsOf(unit.coarse), sum.fine - terms * bitsOf(unit.fine)};
}

INNERSPHERE_HD inline void add(ShortSum& sum, double x, const Unit& unit) {
  addBits(sum, x, unit);
  sum = withoutUnit(sum, 1, unit);
}

/// Returns the sum in units of the quantum.
inline FixedSum toFixed(const ShortSum& sum, const Unit& unit) {
  return shifted(static_cast<std::int64_t>(sum.coarse), unit.fine_bits) +
         shifted(static_cast<std::int64_t>(sum.fine), 0);
}

INNERSPHERE_HD inline double toDouble(const FixedSum& sum, const Unit& unit) {
  using std::ldexp;
  const bool negative = sum.hi >> 63;
  const FixedSum size = negative ? -sum : sum;
  const double x = ldexp(static_cast<double>(size.hi), 64) + static_cast<double>(size.lo);
  return ldexp(negative ? -x : x, -unit.coarse_shift - unit.fine_bits);
}

}  // namespace innersphere::core
