#include "core/fixed_sum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sphere_sets.hpp"

namespace innersphere::test {
namespace {

using core::FixedSum;
using core::ShortSum;
using core::toDouble;
using core::Unit;

/// Terms are below 2^(core::kCoarseBits - coarse_shift).
Unit makeUnit(int coarse_shift, int fine_bits = core::kFineBits) {
  return {std::ldexp(1.5, 52 - coarse_shift), std::ldexp(1.5, 52 - coarse_shift - fine_bits), coarse_shift,
          fine_bits};
}

FixedSum fixed(double x, const Unit& unit) {
  ShortSum sum{0, 0};
  add(sum, x, unit);
  return toFixed(sum, unit);
}

bool equal(const FixedSum& a, const FixedSum& b) {
  return a.lo == b.lo && a.hi == b.hi;
}

TEST(FixedSum, RoundTripIsExactAboveTheQuantum) {
  Random random(1);
  for (int shift : {-200, -40, 0, 60, 120, 900}) {
    for (int fine_bits : {0, 14, core::kFineBits}) {
      const Unit unit = makeUnit(shift, fine_bits);
      for (int i = 0; i < 1000; ++i) {
        const double x = std::ldexp(random.uniform(-1, 1),
                                    static_cast<int>(random.uniform(-fine_bits, core::kCoarseBits)) - shift);
        const double back = toDouble(fixed(x, unit), unit);
        EXPECT_LE(std::fabs(back - x), std::ldexp(0.5, -shift - fine_bits));
        if (std::fabs(x) > std::ldexp(1.0, 53 - shift - fine_bits)) {
          EXPECT_EQ(back, x);
        }
      }
    }
  }
  EXPECT_EQ(toDouble(fixed(0, makeUnit(100)), makeUnit(100)), 0);
  EXPECT_EQ(toDouble(fixed(1e-300, makeUnit(100)), makeUnit(100)), 0);
  EXPECT_EQ(toDouble(fixed(5e-324, makeUnit(100)), makeUnit(100)), 0);
}

TEST(FixedSum, NegatesExactly) {
  Random random(2);
  const Unit unit = makeUnit(38);
  for (int i = 0; i < 1000; ++i) {
    const double x = std::ldexp(random.uniform(-1, 1), static_cast<int>(random.uniform(-130, 10)));
    const FixedSum p = fixed(x, unit), m = fixed(-x, unit);
    EXPECT_TRUE(equal(p + m, {0, 0}));
    EXPECT_EQ(toDouble(p, unit), -toDouble(m, unit));
  }
}

/// However terms are split into short sums, and in whatever order they come.
TEST(FixedSum, AnyOrderGivesTheSameBitsAndTheExactSum) {
  Random random(3);
  const Unit unit = makeUnit(48);
  std::vector<double> terms(2000);
  for (double& x : terms) x = std::ldexp(random.uniform(-1, 1), static_cast<int>(random.uniform(-40, 0)));
  long double exact = 0;
  for (double x : terms) exact += x;
  const auto sum = [&](std::size_t length) {
    FixedSum total{0, 0};
    for (std::size_t k = 0; k < terms.size(); k += length) {
      ShortSum part{0, 0};
      for (std::size_t i = k; i < std::min(k + length, terms.size()); ++i) add(part, terms[i], unit);
      total = total + toFixed(part, unit);
    }
    return total;
  };
  const FixedSum forward = sum(2000);
  EXPECT_TRUE(equal(forward, sum(1)));
  EXPECT_TRUE(equal(forward, sum(7)));
  std::reverse(terms.begin(), terms.end());
  EXPECT_TRUE(equal(forward, sum(256)));
  EXPECT_NEAR(toDouble(forward, unit), static_cast<double>(exact), 1e-15);
}

TEST(FixedSum, ShortSumsHoldTheirLongest) {
  const Unit unit = makeUnit(0);
  for (double sign : {1.0, -1.0}) {
    const double largest = sign * (std::ldexp(1.0, core::kCoarseBits) - 0.25);
    ShortSum sum{0, 0};
    for (int i = 0; i < 1 << core::kShortSumBits; ++i) add(sum, largest, unit);
    EXPECT_EQ(toDouble(toFixed(sum, unit), unit), std::ldexp(largest, core::kShortSumBits));
  }
}

TEST(FixedSum, Shifts) {
  EXPECT_TRUE(equal(core::shifted(5, 0), {5, 0}));
  EXPECT_TRUE(equal(core::shifted(-1, 0), {~std::uint64_t{0}, ~std::uint64_t{0}}));
  EXPECT_TRUE(equal(core::shifted(3, 63), {std::uint64_t{1} << 63, 1}));
  EXPECT_TRUE(equal(core::shifted(-1, 40), {~std::uint64_t{0} << 40, ~std::uint64_t{0}}));
}

}  // namespace
}  // namespace innersphere::test
