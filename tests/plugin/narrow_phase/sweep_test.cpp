// The poses of a step at which a fast pair is searched, and contacts taken back to where the step begins.
#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btBoxShape.h>

#include "narrow_phase/sweep.hpp"
#include "test_packings.hpp"

namespace innersphere::test {
namespace {

constexpr btScalar kStep = btScalar(1) / 60;

/// A cube of 0.2 m above the middle of a static plate whose top is z = 0. It moves at `velocity`.
struct Flight {
  Flight(const btVector3& start, const btVector3& velocity, bool swept = true)
      : now{btTransform(btQuaternion::getIdentity(), start),
            btTransform(btQuaternion::getIdentity(), btVector3(0, 0, -1))} {
    BodyVelocity moving;
    moving.linear = velocity;
    step.motion = PairMotion({0, 0, 0}, moving, btVector3(0, 0, -1) - start, BodyVelocity(), swept);
    step.time_step = kStep;
    step.needed = velocity.length() * kStep;
    step.size = cube->getAngularMotionDisc();
  }
  Sweep sweep() const { return Sweep(*cube, plate, now, step); }
  /// The contact of the cube's lower face with the plate, as a search finds it at a pose.
  std::vector<ContactPatch> contactAt(const Placed& pose) const {
    const btScalar bottom = pose.a.getOrigin().z() - btScalar(0.1);
    if (bottom > step.size) return {};
    ContactPatch patch;
    patch.normal = {0, 0, -1};
    patch.area = 1;
    patch.count = 1;
    patch.points[0].normal = patch.normal;
    patch.points[0].depth = -bottom;
    patch.points[0].on_b = patch.centre = {0, 0, -pose.a.getOrigin().z()};  // below the middle of the cube
    return {patch};
  }

  std::shared_ptr<PackingShape> cube = makeShape(latticeBox({0.2, 0.2, 0.2}, 4));
  btBoxShape plate{btVector3(100, 100, 1)};
  Placed now;
  StepAhead step;
};

TEST(Sweep, HasOnePoseUnlessThePairIsSwept) {
  const Flight flight({0, 0, 1}, {0, 0, -100}, false);
  Sweep sweep = flight.sweep();
  EXPECT_TRUE(sweep.placed() == flight.now);
  EXPECT_EQ(sweep.ahead().needed, flight.step.needed);
  std::vector<ContactPatch> found = flight.contactAt(flight.now);
  EXPECT_FALSE(sweep.goesOn(found));
  sweep.finish(found);
  EXPECT_EQ(found.size(), flight.contactAt(flight.now).size());
}

TEST(Sweep, GoesNoFurtherThanAQuarterOfASizeFromPoseToPose) {
  Flight flight({0, 0, btScalar(0.11)}, {60, 80, 0});  // nothing is found
  Sweep sweep = flight.sweep();
  btVector3 last = flight.now.a.getOrigin();
  btScalar farthest = 0;
  while (sweep.goesOn({})) {
    const btVector3 at = sweep.placed().a.getOrigin();
    if (sweep.placed() == flight.now) continue;  // the last one is the first again
    EXPECT_LE(at.distance(last), flight.step.size / 4 * btScalar(1.0001));
    last = at;
    farthest = btMax(farthest, at.distance(flight.now.a.getOrigin()));
  }
  EXPECT_TRUE(sweep.placed() == flight.now);
  EXPECT_FALSE(sweep.hasKept());
  EXPECT_GE(farthest, flight.step.needed - flight.step.size / 4 * btScalar(1.0001));
}

TEST(Sweep, LeavesOutPosesFarFromTheOtherBody) {
  Flight flight({0, 0, 1}, {0, 0, 100});  // away
  Sweep sweep = flight.sweep();
  int poses = 1;
  while (sweep.goesOn({})) ++poses;
  EXPECT_EQ(poses, 2) << "the first one, and that one again";
}

class TakenBack : public testing::TestWithParam<std::pair<btVector3, double>> {};

TEST_P(TakenBack, TheGapIsThatWhenTheStepBegins) {
  const auto& [velocity, height] = GetParam();
  Flight flight({0, 0, btScalar(height)}, velocity);
  Sweep sweep = flight.sweep();
  std::vector<ContactPatch> found = flight.contactAt(sweep.placed());
  btVector3 way(0, 0, 0);  // to where it has been stopped; it slides on from there
  while (sweep.goesOn(found)) {
    const btVector3 moved = sweep.placed().a.getOrigin() - flight.now.a.getOrigin();
    if (moved.z() < way.z()) way = moved;
    found = flight.contactAt(sweep.placed());
  }
  EXPECT_GE(sweep.placed().a.getOrigin().z(), 0.1) << "searched before they meet";
  sweep.finish(found);
  ASSERT_EQ(found.size(), 1u);
  const ContactPoint& point = found[0].points[0];
  EXPECT_NEAR(point.depth, 0.1 - height, 1e-5);
  // B's point stays where it is, and A's is the one that will come there.
  const btVector3 on_b = flight.now.a.getOrigin() + point.on_b;
  const btVector3 met = {way.x(), way.y(), 0};
  EXPECT_LT(on_b.distance(met), 1e-5);
  const btVector3 on_a = on_b + point.normal * point.depth + point.aside;
  EXPECT_LT(on_a.distance({0, 0, btScalar(height - 0.1)}), 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Flights, TakenBack,
                         testing::Values(std::pair(btVector3(0, 0, -100), 1.4),
                                         std::pair(btVector3(0, 0, -30), 0.4),
                                         std::pair(btVector3(50, 20, -60), 0.9)));

TEST(Sweep, WhatOnlyGrazesDoesNotEndIt) {
  Flight flight({0, 0, btScalar(0.101)}, {100, 0, btScalar(-0.2)});  // it slides
  Sweep sweep = flight.sweep();
  std::vector<ContactPatch> found = flight.contactAt(sweep.placed());
  btScalar farthest = 0;
  while (sweep.goesOn(found)) {
    found = flight.contactAt(sweep.placed());
    farthest = btMax(farthest, sweep.placed().a.getOrigin().x());
  }
  EXPECT_GE(farthest, flight.step.needed - flight.step.size / 4 * btScalar(1.0001));
  sweep.finish(found);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].points[0].depth, -0.001, 1e-6) << "as it is now";
}

}  // namespace
}  // namespace innersphere::test
