// Speeds that pass through in one step. A half space has no other side: whatever falls on a plane comes back
// up, slowly. A body that is behind another one after a step has met nothing: both fly on as they were. What
// is offered: time steps in which it moves by less than half of the thinner of the two, and for a Bullet
// shape that flies into a packing Bullet's own continuous collision detection.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "watched_world.hpp"

namespace innersphere::test {
namespace {

class IntoAPlane : public testing::TestWithParam<double> {};

TEST_P(IntoAPlane, ComesBackUpAndIsNotThrown) {
  const double speed = GetParam();
  WatchedWorld world;
  world.addFloor();
  btRigidBody& box = world.add(makeShape(latticeBox({1, 1, 1}, 6)), 1000, btVector3(0, 0, 1));
  box.setLinearVelocity(btVector3(0, 0, btScalar(-speed)));
  double fastest = 0;
  for (int i = 0; i < 60 * 60; ++i) {
    world.watch(1.0 / 60, 1.0 / 60);
    fastest = std::max(fastest, double(box.getLinearVelocity().z()));
  }
  EXPECT_TRUE(world.finite());
  EXPECT_LE(fastest, 0.05 * speed + 1) << "it must not be thrown up";
  EXPECT_NEAR(box.getWorldTransform().getOrigin().z(), 0.5, 0.01);
}

INSTANTIATE_TEST_SUITE_P(At, IntoAPlane, testing::Values(10.0, 30.0, 100.0, 1000.0), [](const auto& info) {
  return std::to_string(std::lround(info.param)) + "_metres_a_second";
});

/// A cube of 0.2 m against a plate of 0.1 m.
struct Shot {
  WatchedWorld world;
  btRigidBody* cube;
  btRigidBody* plate;

  explicit Shot(double speed) {
    world.world.setGravity(btVector3(0, 0, 0));
    plate = &world.add(makeShape(latticeBox({2, 2, 0.1}, 12)), 0, btVector3(0, 0, 0));
    cube = &world.add(makeShape(latticeBox({0.2, 0.2, 0.2}, 4)), 8, btVector3(0, 0, btScalar(0.777)));
    cube->setLinearVelocity(btVector3(0, 0, btScalar(-speed)));
  }
};

TEST(ThroughAPlate, InOneStepNothingIsMet) {
  constexpr double kSpeed = 200;  // 3.3 m a step
  Shot shot(kSpeed);
  shot.world.watch(0.1, 1.0 / 60);
  EXPECT_NEAR(shot.cube->getLinearVelocity().z(), -kSpeed, 1e-3 * kSpeed) << "as it was";
  EXPECT_LT(shot.cube->getWorldTransform().getOrigin().z(), -10);
  EXPECT_LE(shot.world.gain(), 1e-3 * shot.world.energy());
}

class ShortSteps : public testing::TestWithParam<double> {};

TEST_P(ShortSteps, StopIt) {
  const double speed = GetParam();
  const double dt = 0.4 * 0.1 / speed;  // it moves by 0.4 of the plate's thickness
  Shot shot(speed);
  shot.world.watch(2 / speed, dt);
  EXPECT_TRUE(shot.world.finite());
  EXPECT_GT(shot.cube->getWorldTransform().getOrigin().z(), 0) << "on the side it came from";
  EXPECT_LE(shot.world.gain(), 1e-3 * 4 * speed * speed);
}

INSTANTIATE_TEST_SUITE_P(At, ShortSteps, testing::Values(1.0, 10.0, 100.0, 1000.0), [](const auto& info) {
  return std::to_string(std::lround(info.param)) + "_metres_a_second";
});

TEST(ContinuousDetection, StopsABallOfBulletsOwnInFrontOfAPacking) {
  WatchedWorld world;
  world.world.setGravity(btVector3(0, 0, 0));
  world.add(makeShape(latticeBox({2, 2, 0.1}, 12)), 0, btVector3(0, 0, 0));
  btRigidBody& ball =
      world.add(std::make_shared<btSphereShape>(btScalar(0.05)), 1, btVector3(0, 0, btScalar(0.777)));
  ball.setCcdMotionThreshold(btScalar(0.01));
  ball.setCcdSweptSphereRadius(btScalar(0.04));
  ball.setLinearVelocity(btVector3(0, 0, -1000));
  world.watch(0.5, 1.0 / 60);
  EXPECT_GT(ball.getWorldTransform().getOrigin().z(), 0);
}

}  // namespace
}  // namespace innersphere::test
