// The deepest points between surfaces that are given by formulas.
#include "narrow_phase/deepest_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "narrow_phase/contact_point.hpp"

namespace innersphere::test {
namespace {

const btVector3 kUp(0, 0, 1);
/// In single precision the depth of a flat top does not change any more so near to it [m].
const double kAtTop = sizeof(btScalar) == 4 ? 2e-3 : 1e-4;

/// A height over the plane, with its slopes and one curvature, positive where the solid below it is convex.
struct Height {
  double z, slope_x, slope_y, curvature;
};
using Relief = std::function<Height(double, double)>;

/// The upper half of a ball.
Relief ball(double x0, double y0, double top, double radius) {
  return [=](double x, double y) {
    const double u = x - x0, v = y - y0, h = std::sqrt(radius * radius - u * u - v * v);
    return Height{top - radius + h, -u / h, -v / h, 1 / radius};
  };
}

/// A lies below B: lines go up from each of the starts.
class Reliefs : public SurfaceProbe {
 public:
  /// `b`: seen from above, so that B is convex where it is.
  Reliefs(Relief a, Relief b, std::vector<btVector3> starts)
      : a_(std::move(a)), b_(std::move(b)), starts_(std::move(starts)) {}

  bool probeLine(std::size_t index, const btVector3& direction, const btVector3& shift,
                 OpposedPoints& points) const override {
    const btVector3 from = starts_[index] + shift;
    const Height a = meet(a_, from, direction, 1, points.on_a);
    const Height b = meet(b_, from, direction, -1, points.on_b);
    if (!std::isfinite(a.z) || !std::isfinite(b.z)) return false;
    points.normal_a = btVector3(btScalar(-a.slope_x), btScalar(-a.slope_y), 1).normalized();
    points.normal_b = btVector3(btScalar(b.slope_x), btScalar(b.slope_y), 1).normalized();
    points.curvature_a = btScalar(a.curvature);
    points.curvature_b = btScalar(b.curvature);
    return true;
  }
  btVector3 lineStart(std::size_t index) const override { return starts_[index]; }
  bool nearest(std::size_t, btVector3& direction, OpposedPoints&) const override {
    direction = kUp;
    return true;
  }

  std::vector<ProbedSample> samples() const {
    std::vector<ProbedSample> samples(starts_.size());
    for (std::size_t i = 0; i < starts_.size(); ++i) {
      samples[i].index = i;
      samples[i].id = i;
      samples[i].direction = kUp;
      EXPECT_TRUE(probeLine(i, kUp, btVector3(0, 0, 0), samples[i].points));
    }
    return samples;
  }

 private:
  /// Where a line goes through a relief. Lines are steep: their place over it hardly changes.
  static Height meet(const Relief& relief, const btVector3& from, const btVector3& direction, double side,
                     btVector3& at) {
    Height height{};
    at = from;
    for (int i = 0; i < 50; ++i) {
      height = relief(at.x(), at.y());
      at = from + direction * btScalar((side * height.z - from.z()) / direction.z());
    }
    return height;
  }

  Relief a_, b_;
  std::vector<btVector3> starts_;
};

btVector3 start(double x, double y) {
  return btVector3(btScalar(x), btScalar(y), 0);
}

std::vector<btVector3> grid(double from, double to, int n) {
  std::vector<btVector3> starts;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j)
      starts.push_back(start(from + (to - from) * i / (n - 1), from + (to - from) * j / (n - 1)));
  }
  return starts;
}

TEST(DeepestPoints, OfTwoBallsOverEachOtherIsBetweenTheirCentres) {
  // Radii 1 and 0.5, shifted by 0.12 against each other: that is on the line between their centres. Vertical
  // lines would meet points side by side.
  const Reliefs reliefs(ball(0, 0, 0.01, 1), ball(0.12, 0, 0.01, 0.5),
                        {start(0, 0.1), start(0.2, 0.05), start(0.3, -0.2)});
  std::vector<ProbedSample> samples = reliefs.samples();
  appendDeepestPoints(reliefs, btScalar(0.05), samples);
  ASSERT_EQ(samples.size(), 4u);
  const OpposedPoints& top = samples.back().points;
  EXPECT_EQ(samples.back().id, kDeepestId);
  const double apart = std::hypot(0.12, 1.48), x = 0.12 / apart;
  EXPECT_NEAR(top.on_a.x(), x, kAtTop);
  EXPECT_NEAR(top.on_a.y(), 0, kAtTop);
  EXPECT_NEAR(top.normal_a.x(), x, kAtTop);
  EXPECT_NEAR(top.depthAlong(top.normal_a), 1.5 - apart, 2e-6);
  EXPECT_LT((top.on_a - top.on_b).cross(top.normal_a).length(), 2e-5);
  EXPECT_EQ(samples[0].starts_ascent + samples[1].starts_ascent + samples[2].starts_ascent, 1);
}

TEST(DeepestPoints, OfOneHillIsOne) {
  const Reliefs reliefs(ball(0.1, -0.05, 0.02, 1), ball(0.1, -0.05, 0.02, 1), grid(-0.02, 0.1, 5));
  std::vector<ProbedSample> samples = reliefs.samples();
  appendDeepestPoints(reliefs, btScalar(0.05), samples);
  ASSERT_EQ(samples.size(), 26u);
  EXPECT_NEAR(samples.back().points.on_a.distance(btVector3(btScalar(0.1), btScalar(-0.05), btScalar(0.02))),
              0, kAtTop);
}

// From where it is steep the top cannot be guessed, so that an ascent may end where another one did.
TEST(DeepestPoints, OfOneHillAreAllAtItsTop) {
  const Reliefs reliefs(ball(0.1, -0.05, 0.02, 1), ball(0.1, -0.05, 0.02, 1), grid(-0.2, 0.2, 5));
  std::vector<ProbedSample> samples = reliefs.samples();
  appendDeepestPoints(reliefs, btScalar(0.05), samples);
  ASSERT_GT(samples.size(), 25u);
  for (std::size_t i = 25; i < samples.size(); ++i) {
    const btVector3 top(btScalar(0.1), btScalar(-0.05), btScalar(0.02));
    EXPECT_NEAR(samples[i].points.on_a.distance(top), 0, kAtTop);
  }
}

/// The higher of two balls at each place.
Relief twoBalls(double apart, double top_left, double top_right, double radius) {
  return [=](double x, double y) {
    return x < 0 ? ball(-apart / 2, 0, top_left, radius)(x, y) : ball(apart / 2, 0, top_right, radius)(x, y);
  };
}

const Relief kFlat = [](double, double) { return Height{0, 0, 0, 0}; };

TEST(DeepestPoints, OfTwoHillsAreTwo) {
  const Reliefs reliefs(twoBalls(1, 0.02, 0.01, 0.5), kFlat,
                        {start(-0.6, 0.1), start(-0.4, -0.1), start(0.4, 0.1), start(0.65, 0)});
  std::vector<ProbedSample> samples = reliefs.samples();
  appendDeepestPoints(reliefs, btScalar(0.05), samples);
  ASSERT_EQ(samples.size(), 6u);
  // The deeper one comes first.
  EXPECT_EQ(samples[4].id, kDeepestId);
  EXPECT_EQ(samples[5].id, kDeepestId - 1);
  EXPECT_NEAR(samples[4].points.on_a.distance(btVector3(btScalar(-0.5), 0, btScalar(0.02))), 0, kAtTop);
  EXPECT_NEAR(samples[5].points.on_a.distance(btVector3(btScalar(0.5), 0, btScalar(0.01))), 0, kAtTop);
}

TEST(DeepestPoints, FurtherApartThanTheSeparationDoNotCount) {
  const Reliefs reliefs(twoBalls(1, 0.02, -0.2, 0.5), kFlat, {start(-0.6, 0.1), start(0.4, 0.1)});
  std::vector<ProbedSample> samples = reliefs.samples();
  appendDeepestPoints(reliefs, btScalar(0.05), samples);
  ASSERT_EQ(samples.size(), 3u);
  EXPECT_LT(samples.back().points.on_a.x(), 0);
}

TEST(DeepestPoints, OfManyHillsAreTheFourDeepest) {
  // Seven hills in a row, their tops at -3 to 3.
  const std::vector<double> tops{0.01, 0.05, 0.02, 0.06, 0.03, 0.04, 0.0};
  const Relief row = [&](double x, double y) {
    const double k = std::min(3.0, std::max(-3.0, std::round(x)));
    return ball(k, 0, tops[std::size_t(k + 3)], 0.6)(x, y);
  };
  std::vector<btVector3> starts;
  for (int k = -3; k <= 3; ++k) starts.push_back(start(k + 0.1, 0.1));
  const Reliefs reliefs(row, kFlat, starts);
  std::vector<ProbedSample> samples = reliefs.samples();
  appendDeepestPoints(reliefs, btScalar(0.1), samples);
  ASSERT_EQ(samples.size(), 7u + kPatchPoints);
  const double expected[] = {0.06, 0.05, 0.04, 0.03};
  for (int i = 0; i < kPatchPoints; ++i)
    EXPECT_NEAR(samples[7 + std::size_t(i)].points.depthAlong(kUp), expected[i], 1e-5);
}

TEST(DeepestPoints, OfFlatFacesAreNone) {
  const Reliefs reliefs(kFlat, kFlat, grid(-0.2, 0.2, 3));
  std::vector<ProbedSample> samples = reliefs.samples();
  appendDeepestPoints(reliefs, btScalar(0.05), samples);
  EXPECT_EQ(samples.size(), 9u);
}

TEST(DeepestPoints, AreNotLeftForWhatIsLessDeep) {
  const Reliefs reliefs(ball(0, 0, 0.01, 1), ball(0.3, 0.2, 0.01, 0.7), grid(-0.2, 0.4, 6));
  std::vector<ProbedSample> samples = reliefs.samples();
  double deepest = -1;
  for (const ProbedSample& sample : samples)
    deepest = std::max(deepest, double(sample.points.depthAlong(kUp)));
  appendDeepestPoints(reliefs, 1, samples);
  ASSERT_GT(samples.size(), 36u);
  EXPECT_GE(samples[36].points.depthAlong(kUp), deepest);
}

TEST(Ascent, MovesSamplesNearATopUphillAndNoOthers) {
  const Reliefs reliefs(ball(0, 0, 0.01, 1), kFlat, {start(0.05, 0.02), start(0.5, 0)});
  std::vector<ProbedSample> samples = reliefs.samples();
  const btScalar near = samples[0].points.depthAlong(kUp), far = samples[1].points.depthAlong(kUp);
  ascendBeside(reliefs, samples.size(), samples);
  EXPECT_GT(samples[0].points.depthAlong(kUp), near);
  EXPECT_NEAR(samples[0].points.on_a.x(), 0, 5e-3);
  // Its slope is half a radian.
  EXPECT_EQ(samples[1].points.depthAlong(kUp), far);
}

TEST(FitTogether, SaysWhetherCurvaturesAddUp) {
  EXPECT_TRUE(fitTogether(0, 0));
  EXPECT_FALSE(fitTogether(1, 0));
  EXPECT_FALSE(fitTogether(1, 2));
  EXPECT_TRUE(fitTogether(1, -1));
  EXPECT_TRUE(fitTogether(1, btScalar(-0.8)));
  EXPECT_FALSE(fitTogether(1, btScalar(-0.2)));
  EXPECT_TRUE(fitTogether(btScalar(0.5), -2));
}

}  // namespace
}  // namespace innersphere::test
