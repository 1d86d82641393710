// How a measure is compared with its truth.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/centre_line.hpp"
#include "scenes/floor.hpp"
#include "scenes/pendulum.hpp"
#include "scenes/recording.hpp"
#include "scenes/ring_distance.hpp"
#include "scenes/scene_solids.hpp"
#include "scenes/truth.hpp"
#include "scenes/world.hpp"

namespace innersphere::test {
namespace {

using demo::Outcome;
using demo::Truth;

demo::Recording recordingOf(double seconds) {
  demo::Recording recording;
  for (int i = 0; i <= 10; ++i) {
    demo::StepRecord step;
    step.time = seconds * i / 10;
    step.kinetic = i % 2;  // up and down by 1 J
    recording.steps.push_back(step);
    demo::BodyState state;
    state.position = {0.1 * i, 0, 0};
    state.rotation = {0, 0, std::sin(0.05 * i), std::cos(0.05 * i)};  // by 0.1 rad a step about z
    recording.states.push_back(state);
  }
  recording.names = {"body"};
  return recording;
}

Truth truthThat(Truth::Kind kind, double measured, double expected, double tolerance) {
  return {"x", "m", kind, expected, tolerance, "", [measured](const demo::Recording&) { return measured; },
          0.5};
}

// Where it ends between two steps, the nearest one counts.
TEST(Verdict, NeedsATimeThatHasBeenSimulated) {
  const auto outcome = [](double seconds) {
    return judge({truthThat(Truth::Kind::equal, 1, 1, 0)}, recordingOf(seconds))[0].outcome;
  };
  EXPECT_EQ(outcome(0.5), Outcome::holds);
  EXPECT_EQ(outcome(0.499998), Outcome::holds);     // 600 steps of 0.00833333 s, not of 1/120
  EXPECT_EQ(outcome(0.45), Outcome::not_recorded);  // a step is 0.045 s
}

TEST(Verdict, FollowsFromToleranceOrBound) {
  const demo::Recording recording = recordingOf(1);
  const auto outcome = [&](Truth::Kind kind, double measured) {
    return judge({truthThat(kind, measured, 2, kind == Truth::Kind::equal ? 0.5 : 0)}, recording)[0].outcome;
  };
  EXPECT_EQ(outcome(Truth::Kind::equal, 2.5), Outcome::holds);
  EXPECT_EQ(outcome(Truth::Kind::equal, 1.5), Outcome::holds);
  EXPECT_EQ(outcome(Truth::Kind::equal, 2.51), Outcome::missed);
  EXPECT_EQ(outcome(Truth::Kind::equal, 1.49), Outcome::missed);
  EXPECT_EQ(outcome(Truth::Kind::at_most, 2), Outcome::holds);
  EXPECT_EQ(outcome(Truth::Kind::at_most, -100), Outcome::holds);
  EXPECT_EQ(outcome(Truth::Kind::at_most, 2.01), Outcome::missed);
  for (const auto kind : {Truth::Kind::equal, Truth::Kind::at_most}) {
    EXPECT_EQ(outcome(kind, std::nan("")), Outcome::missed) << "what is not a number is not shown";
    EXPECT_EQ(outcome(kind, INFINITY), Outcome::missed);
  }
  EXPECT_NEAR(demo::missOf(truthThat(Truth::Kind::equal, 0, 2, 0.5), 3), 0.5, 1e-12);
}

TEST(Verdict, IsOpenWhereTheRecordingIsTooShort) {
  const Truth truth = truthThat(Truth::Kind::equal, 2, 2, 0);
  EXPECT_EQ(judge({truth}, recordingOf(0.4))[0].outcome, Outcome::not_recorded);
  EXPECT_EQ(judge({truth}, recordingOf(0.5))[0].outcome, Outcome::holds);
}

TEST(Recording, FindsStepsWaysTurnsAndGains) {
  const demo::Recording recording = recordingOf(1);
  EXPECT_EQ(recording.stepAt(0), 0u);
  EXPECT_EQ(recording.stepAt(0.44), 4u);
  EXPECT_EQ(recording.stepAt(0.46), 5u);
  EXPECT_EQ(recording.stepAt(7), 10u);
  EXPECT_NEAR(recording.farthestFrom(0), 1, 1e-12);
  EXPECT_NEAR(recording.farthestFrom(0, 0.5), 0.5, 1e-12);
  EXPECT_NEAR(recording.turnBetween(0, 0.2, 0.9), 0.7, 1e-12);
  EXPECT_NEAR(recording.energyGained(), 4, 1e-12) << "four rises by 1 J; the start is in no step's middle";
}

TEST(Recording, FreeFlightGainsNoEnergy) {
  // A body of 1 kg that is thrown up, as Bullet steps it, and as a solver with substeps does.
  constexpr double kGravity = 9.81, kDt = 0.01;
  for (const int substeps : {1, 16}) {
    demo::Recording recording;
    double speed = 5, height = 0;
    for (int i = 0; i <= 200; ++i) {
      demo::StepRecord step;
      step.kinetic = speed * speed / 2;
      step.potential = kGravity * height;
      step.substeps = substeps;
      recording.steps.push_back(step);
      for (int k = 0; k < substeps; ++k) {
        speed -= kGravity * kDt / substeps;
        height += speed * kDt / substeps;
      }
    }
    EXPECT_NEAR(recording.energyGained(), 0, 1e-10) << substeps;
  }
}

TEST(Floor, IsAsHighAsItIsUnderEachBody) {
  demo::SceneOptions options;
  options.spheres = 64;
  demo::SceneWorld world({});
  const double size = 0.5, lower = 0.06;
  const std::size_t torus = addSolids(world, options, {"torus"}, size)[0];
  world.addBody(torus, 1, btTransform::getIdentity(), {});
  expectNoneInFloor(
      world, [&](double x, double) { return x < 1 ? 0 : -lower; }, 0);
  const auto depthAt = [&](double x, double z) {
    demo::Recording recording = recordingOf(1);
    for (demo::BodyState& state : recording.states) state.position = {x, 0, z};
    return world.truths[1].measure(recording) * size;
  };
  EXPECT_NEAR(depthAt(0, 0) - depthAt(0, 0.1), 0.1, 1e-6);
  EXPECT_NEAR(depthAt(0, 0) - depthAt(2, 0), lower, 1e-6);
}

TEST(RingDistance, OfRingsInKnownPlaces) {
  demo::BodyState a, b;
  b.position = {0, 0, 0.3};
  EXPECT_NEAR(distanceOfRings(a, b, 2, 1), 0.3, 1e-6) << "one above the other";
  b.position = {2.5, 0, 0};
  EXPECT_NEAR(distanceOfRings(a, b, 2, 1), 0.5, 1e-6) << "side by side";
  b.position = {1.5, 0, 0};
  b.rotation = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
  EXPECT_NEAR(distanceOfRings(a, b, 2, 1), 0.5, 1e-6) << "interlocked, at right angles";
}

TEST(CentreLine, OfTubesInKnownPlaces) {
  demo::Recording recording;
  recording.names = {"a", "b"};
  recording.states.resize(2);
  recording.states[1].position = {0.25, 0, 0.5};
  recording.states[1].rotation = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};  // a quarter about z: x becomes y
  const demo::CentreLine a{0, {{-1, 0, 0}, {1, 0, 0}}, false};
  EXPECT_NEAR(demo::distanceOf(a, {1, {{0, 0.25, 0}, {1, 0.25, 0}}, false}, recording, 0), 0.5, 1e-12)
      << "its end is above the other's middle";
  EXPECT_NEAR(demo::distanceOf(a, {1, {{1, 0, 0}, {3, 1, 0}, {3, -1, 0}}, true}, recording, 0),
              std::hypot(1, 0.5), 1e-12)
      << "a triangle, nearest with a corner";
}

TEST(Pendulum, PeriodGrowsWithTheAmplitude) {
  const double small = 2 * M_PI / std::sqrt(9.81);
  EXPECT_NEAR((demo::Pendulum{{}, 1, 1e-6}.period()), small, 1e-9);
  EXPECT_NEAR((demo::Pendulum{{}, 4, 1e-6}.period()), 2 * small, 1e-9);
  EXPECT_NEAR((demo::Pendulum{{}, 1, M_PI / 2}.period()), 1.1803405990 * small, 1e-8) << "2 K(1/2) / pi";
}

}  // namespace
}  // namespace innersphere::test
