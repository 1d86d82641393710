#include "core/fixed_sum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sphere_sets.hpp"

namespace innersphere::test {
namespace {

using core::FixedSum;
using core::toDouble;
using core::toFixed;

TEST(FixedSum, RoundTripIsExactAboveTheQuantum) {
  Random random(1);
  for (int shift : {-40, 0, 60, 120, 200}) {
    for (int i = 0; i < 1000; ++i) {
      const double x = std::ldexp(random.uniform(-1, 1),
                                  static_cast<int>(random.uniform(54, core::kFixedBits - 1)) - shift);
      const double back = toDouble(toFixed(x, shift), shift);
      EXPECT_NEAR(back, x, std::ldexp(1.0, -shift));
      if (std::fabs(x) > std::ldexp(1.0, 53 - shift)) {
        EXPECT_EQ(back, x);
      }
    }
  }
  EXPECT_EQ(toDouble(toFixed(0, 100), 100), 0);
  EXPECT_EQ(toDouble(toFixed(1e-300, 100), 100), 0);
  EXPECT_EQ(toDouble(toFixed(5e-324, 100), 100), 0);
}

TEST(FixedSum, NegatesExactly) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const double x = std::ldexp(random.uniform(-1, 1), static_cast<int>(random.uniform(-130, 10)));
    const FixedSum p = toFixed(x, 110), m = toFixed(-x, 110), zero = p + m;
    EXPECT_EQ(zero.lo, 0u);
    EXPECT_EQ(zero.hi, 0u);
    EXPECT_EQ(toDouble(p, 110), -toDouble(m, 110));
  }
}

TEST(FixedSum, AnyOrderGivesTheSameBitsAndTheExactSum) {
  Random random(3);
  std::vector<double> terms(2000);
  for (double& x : terms) x = std::ldexp(random.uniform(-1, 1), static_cast<int>(random.uniform(-40, 0)));
  long double exact = 0;
  for (double x : terms) exact += x;
  FixedSum forward{0, 0}, backward{0, 0};
  for (double x : terms) forward = forward + toFixed(x, 100);
  std::reverse(terms.begin(), terms.end());
  for (double x : terms) backward = backward + toFixed(x, 100);
  EXPECT_EQ(forward.lo, backward.lo);
  EXPECT_EQ(forward.hi, backward.hi);
  EXPECT_NEAR(toDouble(forward, 100), static_cast<double>(exact), 1e-15);
}

TEST(FixedSum, CarriesBetweenTheHalves) {
  FixedSum sum{0, 0};
  for (int i = 0; i < 5; ++i) sum = sum + toFixed(0.75, 64);
  EXPECT_EQ(toDouble(sum, 64), 3.75);
  for (int i = 0; i < 6; ++i) sum = sum + toFixed(-0.75, 64);
  EXPECT_EQ(toDouble(sum, 64), -0.75);
}

}  // namespace
}  // namespace innersphere::test
