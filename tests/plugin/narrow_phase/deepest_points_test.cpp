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

const Relief kFlat = [](double, double) { return Height{0, 0, 0, 0}; };

/// A lies below B: lines go up from each of the starts.
class Reliefs : public SurfaceProbe {
 public:
  btScalar meets(bool, const btVector3&, const btVector3&) const override { return -1; }
  /// `b`: seen from above, so that B is convex where it is.
  Reliefs(Relief a, Relief b, std::vector<btVector3> starts, std::vector<btScalar> reaches = {})
      : a_(std::move(a)), b_(std::move(b)), starts_(std::move(starts)), reaches_(std::move(reaches)) {
    for (std::size_t i = 0; i < starts_.size(); ++i) all_.push_back(i);
  }

  bool probeLine(std::size_t index, const btVector3& direction, const btVector3& shift,
                 OpposedPoints& points) const override {
    if (shift.length() > reach(index)) return false;
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
  btScalar reach(std::size_t index) const override { return reaches_.empty() ? 10 : reaches_[index]; }
  bool nearest(std::size_t, btVector3& direction, OpposedPoints&) const override {
    direction = kUp;
    return true;
  }

  LineStarts lines() const { return {*this, all_, room_}; }

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
  std::vector<std::size_t> all_;
  mutable std::vector<LineStarts::Start> room_;
  std::vector<btScalar> reaches_;
};

/// With no tops of the step before.
void appendDeepest(const Reliefs& reliefs, btScalar separation, std::vector<ProbedSample>& samples) {
  appendDeepestPoints(reliefs.lines(), separation, {}, 0, samples);
}

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
  appendDeepest(reliefs, btScalar(0.05), samples);
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

// The top is three times as far away as a line from the small sphere reaches: the large one takes over.
TEST(DeepestPoints, OutOfReachOfASphereAreReachedFromAnother) {
  const btScalar small = btScalar(0.1), large = btScalar(0.5);
  const Relief hill = ball(0, 0, 0.01, 1);
  const Reliefs reliefs(hill, kFlat, {start(-0.3, 0), start(0.05, 0)}, {small, large});
  std::vector<ProbedSample> samples{reliefs.samples()[0]};
  appendDeepest(reliefs, btScalar(0.05), samples);
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_TRUE(samples[1].is_top);
  EXPECT_NEAR(samples[1].points.on_a.x(), 0, kAtTop);
  EXPECT_NEAR(samples[1].points.depthAlong(kUp), 0.01, 1e-6);
  // Alone it ends on its way.
  const Reliefs alone(hill, kFlat, {start(-0.3, 0)}, {small});
  samples = alone.samples();
  appendDeepest(alone, btScalar(0.05), samples);
  EXPECT_FALSE(samples.back().is_top);
}

// The large sphere is of another wall: it sees other places.
TEST(DeepestPoints, AreNotLookedForFromSpheresOfOtherWalls) {
  class TwoWalls : public Reliefs {
   public:
    using Reliefs::Reliefs;
    bool probeLine(std::size_t index, const btVector3& direction, const btVector3& shift,
                   OpposedPoints& points) const override {
      if (!Reliefs::probeLine(index, direction, shift, points)) return false;
      if (index == 1) points.on_a -= kUp * btScalar(0.2);
      return true;
    }
  };
  const TwoWalls walls(ball(0, 0, 0.01, 1), kFlat, {start(-0.3, 0), start(0.05, 0)},
                       {btScalar(0.1), btScalar(0.5)});
  std::vector<ProbedSample> samples{walls.samples()[0]};
  appendDeepest(walls, btScalar(0.05), samples);
  EXPECT_FALSE(samples.back().is_top);
  EXPECT_GT(samples.back().points.depthAlong(kUp), -0.05);
}

TEST(DeepestPoints, OfOneHillIsOne) {
  const Reliefs reliefs(ball(0.1, -0.05, 0.02, 1), ball(0.1, -0.05, 0.02, 1), grid(-0.02, 0.1, 5));
  std::vector<ProbedSample> samples = reliefs.samples();
  appendDeepest(reliefs, btScalar(0.05), samples);
  ASSERT_EQ(samples.size(), 26u);
  EXPECT_NEAR(samples.back().points.on_a.distance(btVector3(btScalar(0.1), btScalar(-0.05), btScalar(0.02))),
              0, kAtTop);
}

// From where it is steep the top cannot be guessed, so that an ascent may end where another one did.
TEST(DeepestPoints, OfOneHillAreAllAtItsTop) {
  const Reliefs reliefs(ball(0.1, -0.05, 0.02, 1), ball(0.1, -0.05, 0.02, 1), grid(-0.2, 0.2, 5));
  std::vector<ProbedSample> samples = reliefs.samples();
  appendDeepest(reliefs, btScalar(0.05), samples);
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

TEST(DeepestPoints, OfTwoHillsAreTwo) {
  const Reliefs reliefs(twoBalls(1, 0.02, 0.01, 0.5), kFlat,
                        {start(-0.6, 0.1), start(-0.4, -0.1), start(0.4, 0.1), start(0.65, 0)});
  std::vector<ProbedSample> samples = reliefs.samples();
  appendDeepest(reliefs, btScalar(0.05), samples);
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
  appendDeepest(reliefs, btScalar(0.05), samples);
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
  appendDeepest(reliefs, btScalar(0.1), samples);
  ASSERT_EQ(samples.size(), 7u + kPatchPoints);
  const double expected[] = {0.06, 0.05, 0.04, 0.03};
  for (int i = 0; i < kPatchPoints; ++i)
    EXPECT_NEAR(samples[7 + std::size_t(i)].points.depthAlong(kUp), expected[i], 1e-5);
}

/// A contact at the top of the step before.
ContactPoint topAt(double x, double y) {
  ContactPoint point;
  point.on_b = start(x, y);
  point.normal = kUp;
  point.id = kDeepestId;
  return point;
}

// Two tops of the same hill, side by side, as triangles make them: the sample leads to one, the step before
// knew the other.
TEST(DeepestPoints, OfAHillWithTwoTopsIsTheOneOfTheStepBefore) {
  const Reliefs reliefs(twoBalls(0.02, 0.01, 0.01, 0.5), kFlat, {start(-0.05, 0), start(-0.03, 0.02)});
  std::vector<ProbedSample> samples = reliefs.samples();
  appendDeepest(reliefs, btScalar(0.05), samples);
  ASSERT_EQ(samples.size(), 3u);
  EXPECT_NEAR(samples[2].points.on_a.x(), -0.01, kAtTop);

  std::vector<Top> tops;
  const LineStarts lines = reliefs.lines();
  ascendAgain(lines, btScalar(0.05), {topAt(0.012, 0)}, tops);
  ASSERT_EQ(tops.size(), 1u);
  samples = reliefs.samples();
  appendDeepestPoints(lines, btScalar(0.05), tops, 1, samples);
  ASSERT_EQ(samples.size(), 3u);
  EXPECT_EQ(samples[2].id, kDeepestId);
  EXPECT_NEAR(samples[2].points.on_a.x(), 0.01, kAtTop);
  // The patch that does not have it does not climb its hill.
  samples = reliefs.samples();
  appendDeepestPoints(lines, btScalar(0.05), tops, 0, samples);
  EXPECT_EQ(samples.size(), 2u);
}

TEST(DeepestPoints, OfTheStepBeforeCountOnceForEachHillAndOnlyWhereTheyAreThere) {
  const Relief hills = twoBalls(1, 0.02, 0.01, 0.5);
  const Relief gap = [=](double x, double y) { return x > 0 ? Height{std::nan(""), 0, 0, 0} : hills(x, y); };
  const std::vector<btVector3> starts{start(-0.5, 0), start(0.5, 0)};
  const std::vector<ContactPoint> before{topAt(-0.5, 0.01), topAt(-0.49, 0), topAt(0.5, 0)};
  std::vector<Top> tops;
  const Reliefs both(hills, kFlat, starts), left(gap, kFlat, starts);
  ascendAgain(both.lines(), btScalar(0.05), before, tops);
  EXPECT_EQ(tops.size(), 2u);
  ascendAgain(left.lines(), btScalar(0.05), before, tops);
  ASSERT_EQ(tops.size(), 1u);
  EXPECT_NEAR(tops[0].sample.points.on_a.x(), -0.5, kAtTop);
}

TEST(DeepestPoints, OfFlatFacesAreNone) {
  const Reliefs reliefs(kFlat, kFlat, grid(-0.2, 0.2, 3));
  std::vector<ProbedSample> samples = reliefs.samples();
  appendDeepest(reliefs, btScalar(0.05), samples);
  EXPECT_EQ(samples.size(), 9u);
}

TEST(DeepestPoints, AreNotLeftForWhatIsLessDeep) {
  const Reliefs reliefs(ball(0, 0, 0.01, 1), ball(0.3, 0.2, 0.01, 0.7), grid(-0.2, 0.4, 6));
  std::vector<ProbedSample> samples = reliefs.samples();
  double deepest = -1;
  for (const ProbedSample& sample : samples)
    deepest = std::max(deepest, double(sample.points.depthAlong(kUp)));
  appendDeepest(reliefs, 1, samples);
  ASSERT_GT(samples.size(), 36u);
  EXPECT_GE(samples[36].points.depthAlong(kUp), deepest);
}

TEST(Ascent, MovesSamplesNearATopUphillAndNoOthers) {
  const Reliefs reliefs(ball(0, 0, 0.01, 1), kFlat, {start(0.05, 0.02), start(0.5, 0)});
  std::vector<ProbedSample> samples = reliefs.samples();
  const btScalar near = samples[0].points.depthAlong(kUp), far = samples[1].points.depthAlong(kUp);
  ascendBeside(reliefs.lines(), samples.size(), samples);
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
  EXPECT_FALSE(fitTogether(1, btScalar(-0.99)));
  EXPECT_FALSE(fitTogether(1, btScalar(-0.2)));
  EXPECT_TRUE(fitTogether(btScalar(0.5), -2));
}

}  // namespace
}  // namespace innersphere::test
