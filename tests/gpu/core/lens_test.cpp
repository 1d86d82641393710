// The lens functions against long double, written independently, and against Monte-Carlo.
#include "core/lens.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sphere_sets.hpp"

namespace innersphere::test {
namespace {

using Real = long double;
constexpr Real kPi = 3.141592653589793238462643383279502884L;

/// The usual closed forms, with the depth s given so that they start without cancellation.
Real volume(Real r1, Real r2, Real s) {
  const Real R = r1 + r2, D = std::fabs(r1 - r2), d = R - s;
  if (d <= D) return 4 * kPi / 3 * std::pow(std::min(r1, r2), 3);
  return kPi * s * s * (d * d + 2 * d * R - 3 * D * D) / (12 * d);
}

Real rimArea(Real r1, Real r2, Real s) {
  const Real R = r1 + r2, D = std::fabs(r1 - r2), d = R - s;
  if (d <= D) return 0;
  // The radii meet where Heron's triangle of sides r1, r2, d has its height.
  const Real area2 = (R + d) * s * (d - D) * (d + D) / 16;
  return kPi * 4 * area2 / (d * d);
}

/// Integral of the volume from the distance to the sum of the radii, by Gauss-Legendre quadrature on panels
/// that shrink towards small distances.
Real energy(Real r1, Real r2, Real s) {
  static const Real x[4] = {0.1834346424956498049394761L, 0.5255324099163289858177390L,
                            0.7966664774136267395915539L, 0.9602898564975362316835609L};
  static const Real w[4] = {0.3626837833783619829651504L, 0.3137066458778872873379622L,
                            0.2223810344533744705443560L, 0.1012285362903762591525314L};
  const Real R = r1 + r2, D = std::fabs(r1 - r2);
  Real sum = 0, from = std::min(s, R - D);
  if (s > from) sum += volume(r1, r2, s) * (s - from);
  while (from > 0) {
    const Real step = D > 0 ? 0.15L * (R - from) : R / 20;
    const Real to = std::max<Real>(0, from - step);
    const Real middle = (from + to) / 2, half = (from - to) / 2;
    for (int i = 0; i < 4; ++i)
      sum += half * w[i] * (volume(r1, r2, middle - half * x[i]) + volume(r1, r2, middle + half * x[i]));
    from = to;
  }
  return sum;
}

struct Radii {
  double a, b;
};
const Radii kRadii[] = {{1, 1},    {1, 0.999}, {1, 0.5},  {1, 0.1},     {1, 1e-2},
                        {1, 1e-3}, {1, 1e-4},  {1e-4, 1}, {3e-7, 2e-7}, {5e4, 7}};

/// Depths from hardly touching to concentric, thick around the point where one ball is just inside the other.
std::vector<double> depths(const Radii& r) {
  const double small = std::min(r.a, r.b), sum = r.a + r.b;
  std::vector<double> s;
  for (double x : {1e-12, 1e-9, 1e-6, 1e-4, 1e-2, 0.1, 0.3, 0.5, 0.9, 1.0, 1.3, 1.7, 1.9, 1.99, 1.9999,
                   1.999999, 2.0, 2.000001, 2.1}) {
    if (x * small <= sum) s.push_back(x * small);
  }
  for (double x : {0.5, 0.9, 0.999, 1.0}) s.push_back(std::max(2 * small, x * sum));
  return s;
}

core::Balls balls(double ra, double rb, double d, double s) {
  return {ra, rb, d, s, 1 / d, 1 / (ra + rb)};
}

TEST(Lens, AgreesWithLongDouble) {
  constexpr double kTolerance = 1e-11;
  for (const Radii& r : kRadii) {
    const Real small = std::min(r.a, r.b), sum = Real{r.a} + r.b;
    for (double s : depths(r)) {
      const double d = static_cast<double>(std::max<Real>(0, sum - s));
      SCOPED_TRACE(testing::Message() << r.a << " " << r.b << " depth " << s);
      const core::Lens lens = core::lens(balls(r.a, r.b, d, s));
      const Real v = volume(r.a, r.b, s), rim = rimArea(r.a, r.b, s), u = energy(r.a, r.b, s);
      EXPECT_NEAR(static_cast<double>(lens.volume / v), 1, kTolerance);
      // The rim vanishes where one ball goes inside the other; there it is as exact as the depth is.
      EXPECT_NEAR(
          lens.rim_area, static_cast<double>(rim),
          kTolerance * static_cast<double>(std::max(rim, std::min<Real>(1, s / small) * small * small)));
      EXPECT_NEAR(static_cast<double>(core::lensEnergy(balls(r.a, r.b, d, s)) / u), 1, 3 * kTolerance);
      EXPECT_GE(lens.moment, 0);
      EXPECT_LE(lens.moment, lens.volume * (1 + 1e-15));
    }
  }
}

TEST(Lens, Logarithm) {
  Random random(5);
  for (int i = 0; i < 20000; ++i) {
    const double x = i % 2 ? random.uniform(1e-3, 1) : std::exp(random.uniform(-690, 0));
    const Real exact = std::log(Real{x});
    EXPECT_NEAR(core::detail::logarithm(x), static_cast<double>(exact),
                5e-16 * std::fabs(static_cast<double>(exact)))
        << x;
  }
  EXPECT_EQ(core::detail::logarithm(1), 0);
}

TEST(Lens, SmallDistancesOfEqualBalls) {
  for (double d : {0.0, 1e-300, 1e-30, 1e-17, 1e-16, 1e-15, 1e-8, 1e-4}) {
    const core::Lens lens = core::lens(balls(1, 1, d, 2 - d));
    const Real expected = kPi / 12 * (2 - Real{d}) * (2 - Real{d}) * (Real{d} + 4);
    EXPECT_NEAR(lens.volume, static_cast<double>(expected), 1e-14) << d;
    EXPECT_NEAR(lens.moment, 0.5 * lens.volume, 1e-14) << d;
    EXPECT_NEAR(core::lensEnergy(balls(1, 1, d, 2 - d)), static_cast<double>(energy(1, 1, 2 - Real{d})),
                1e-13)
        << d;
  }
}

TEST(Lens, IsSymmetricToTheLastBit) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const double a = random.uniform(0.1, 1), b = random.uniform(0.1, 1), d = random.uniform(0, a + b),
                 s = a + b - d;
    const core::Lens x = core::lens(balls(a, b, d, s)), y = core::lens(balls(b, a, d, s));
    EXPECT_EQ(x.volume, y.volume);
    EXPECT_EQ(x.rim_area, y.rim_area);
    EXPECT_EQ(core::lensEnergy(balls(a, b, d, s)), core::lensEnergy(balls(b, a, d, s)));
    EXPECT_NEAR(x.moment + y.moment, x.volume, 1e-15);
  }
}

TEST(Lens, RimAreaIsMinusTheDerivativeOfVolume) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const double a = random.uniform(0.1, 1), b = random.uniform(0.1, 1);
    const double d = random.uniform(std::fabs(a - b) + 0.01, a + b - 0.01), h = 1e-5;
    const double slope = (core::lens(balls(a, b, d + h, a + b - d - h)).volume -
                          core::lens(balls(a, b, d - h, a + b - d + h)).volume) /
                         (2 * h);
    EXPECT_NEAR(core::lens(balls(a, b, d, a + b - d)).rim_area, -slope, 1e-7);
  }
}

/// Volume and centroid by counting points, within five standard errors.
TEST(Lens, MonteCarlo) {
  Random random(3);
  for (const auto& [a, b, d] :
       {std::array{1.0, 0.7, 1.2}, std::array{1.0, 0.4, 0.7}, std::array{0.5, 0.9, 0.3}}) {
    constexpr int kPoints = 400000;
    const double lo = std::max(-a, d - b), hi = std::min(a, d + b), side = std::min(a, b);
    double inside = 0, sum_x = 0;
    for (int i = 0; i < kPoints; ++i) {
      const double x = random.uniform(lo, hi), y = random.uniform(-side, side),
                   z = random.uniform(-side, side);
      if (x * x + y * y + z * z < a * a && (x - d) * (x - d) + y * y + z * z < b * b) ++inside, sum_x += x;
    }
    const double box = (hi - lo) * 4 * side * side, share = inside / kPoints;
    const core::Lens lens = core::lens(balls(a, b, d, a + b - d));
    EXPECT_NEAR(lens.volume, box * share, 5 * box * std::sqrt(share * (1 - share) / kPoints));
    EXPECT_NEAR(lens.moment / lens.volume * d, sum_x / inside, 5 * (hi - lo) / std::sqrt(inside));
  }
}

TEST(Lens, CentroidOfTheInnerBall) {
  const core::Lens b_inside = core::lens(balls(1.0, 0.2, 0.3, 0.9)),
                   a_inside = core::lens(balls(0.2, 1.0, 0.3, 0.9));
  EXPECT_EQ(b_inside.moment, b_inside.volume);
  EXPECT_EQ(a_inside.moment, 0);
}

}  // namespace
}  // namespace innersphere::test
