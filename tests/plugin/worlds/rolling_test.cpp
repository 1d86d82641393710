// What brakes balls: next to nothing where they roll, the friction of a small round contact where they spin.
#include <cmath>

#include <gtest/gtest.h>

#include "innersphere/mesh.hpp"
#include "innersphere/solids.hpp"
#include "innersphere/substep_solver.hpp"
#include "named_packings.hpp"
#include "outline_meshes.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kRadius = 0.5, kGravity = 9.81, kStep = 1.0 / 240;

/// A ball of 1 kg that has come to lie on the plane.
btRigidBody& addBall(TestWorld& world) {
  world.world.getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  world.addFloor().setFriction(1);
  btRigidBody& ball = world.add(makeNamedShape("ball", 500, kRadius), 1, btVector3(0, 0, btScalar(kRadius)));
  ball.setFriction(1);
  ball.setActivationState(DISABLE_DEACTIVATION);
  world.run(0.5, kStep);
  return ball;
}

double inertiaOf(const btRigidBody& body) {
  return 1 / double(body.getInvInertiaDiagLocal().z());
}

void roll(btRigidBody& ball, double speed) {
  ball.setLinearVelocity(btVector3(btScalar(speed), 0, 0));
  ball.setAngularVelocity(btVector3(0, btScalar(speed / kRadius), 0));
}

// A load that lies a lever ahead of the middle slows the ball by g lever / R / (1 + I / (m R^2)).
TEST(Rolling, IsHardlyBraked) {
  TestWorld world;
  btRigidBody& ball = addBall(world);
  roll(ball, 1);
  world.run(10, kStep);
  const double slowing = kGravity * 1e-5 * kRadius / kRadius / 1.4;
  EXPECT_NEAR(1 - ball.getLinearVelocity().x(), 10 * slowing, 0.3 * 10 * slowing);
}

TEST(Rolling, IsBrakedAsTheUserSays) {
  TestWorld world;
  btRigidBody& ball = addBall(world);
  constexpr double kLever = 0.02;
  ball.setRollingFriction(btScalar(kLever));
  roll(ball, 1);
  world.run(1, kStep);
  const double slowing = kGravity * kLever / kRadius / 1.4;
  EXPECT_NEAR(1 - ball.getLinearVelocity().x(), slowing, 0.05 * slowing);
}

// The pressure of a round contact of radius a, as Hertz has it, is 3 pi / 16 a from its middle on average; a
// ball that is d deep has a = sqrt(R d).
TEST(Rolling, ASpinningBallIsBrakedByItsContact) {
  TestWorld world;
  btRigidBody& ball = addBall(world);
  const double depth = -double(world.contactsOfLast().at(0).getDistance());
  ball.setAngularVelocity(btVector3(0, 0, 5));
  constexpr double kSeconds = 2;
  world.run(kSeconds, kStep);
  const double torque = kGravity * 3 * M_PI / 16 * std::sqrt(kRadius * depth);
  const double slowing = torque / inertiaOf(ball);
  EXPECT_NEAR(5 - ball.getAngularVelocity().z(), kSeconds * slowing, 0.05 * kSeconds * slowing);
  EXPECT_LT(ball.getLinearVelocity().length(), 1e-3);
}

/// A disc that rolls on a flat packed floor keeps its speed. Ascents to the line that it lies on ran off its
/// end, so that it had no top, and places ahead of it bore it: 0.71 m/s were left of 1 at 60 steps/s. With
/// tops at both ends of the line, those beside the rest of it bore still: 0.93.
TEST(Rolling, ADiscOnAPackedFloorIsHardlyBraked) {
  constexpr double kOuter = 0.3, kSpeed = 1;
  const Mesh disc = turnedMesh({{0, -0.04}, {kOuter, -0.04}, {kOuter, 0.04}, {0, 0.04}}, 96);
  const auto shape = makePackedShape(*makeSolid(disc, "disc"), 256);
  const auto floor = makePackedShape(*makeBox({14, 2, 0.3}), 256);
  for (const bool substeps : {false, true}) {
    for (const double rate : {60.0, 240.0}) {
      TestWorld world;
      SubstepSolver solver;
      if (substeps) world.world.setConstraintSolver(&solver);
      PackingCollisionAlgorithm::prepareWorld(world.world);
      world.add(floor, 0, btVector3(5, 0, btScalar(-0.15))).setFriction(1);
      btRigidBody& body = world.add(shape, 1, btVector3(0, 0, 0));
      body.setFriction(btScalar(0.6));
      const btQuaternion upright(btVector3(1, 0, 0), SIMD_HALF_PI);
      body.setWorldTransform(shape->bodyTransform(btTransform(upright, btVector3(0, 0, btScalar(kOuter)))));
      body.setLinearVelocity(btVector3(btScalar(kSpeed), 0, 0));
      body.setAngularVelocity(btVector3(0, btScalar(kSpeed / kOuter), 0));
      world.run(2, 1 / rate);
      const double lost = rate < 100 && !substeps ? 0.05 : 0.04;
      EXPECT_GT(body.getLinearVelocity().x(), (1 - lost) * kSpeed) << substeps << rate;
      EXPECT_LT(body.getLinearVelocity().x(), 1.001 * kSpeed) << substeps << rate;
      world.world.setConstraintSolver(&world.solver);
    }
  }
}

// A disc that slides down a packed slope, and spins up as it does, moves by g (sin - mu cos). Of what is near
// ahead of the step, the flat road bears it: a normal of the disc's own, which spins past, has a speed that
// nothing approaches with, and throws it up.
TEST(Rolling, ADiscSlidesDownAPackedSlope) {
  constexpr double kOuter = 0.3, kSlope = 0.9, kFriction = 0.2, kSeconds = 1.2;
  const Mesh disc = turnedMesh({{0, -0.05}, {kOuter, -0.05}, {kOuter, 0.05}, {0, 0.05}}, 128);
  for (const bool substeps : {false, true}) {
    for (const double rate : {120.0, 240.0}) {
      TestWorld world;
      SubstepSolver solver;
      if (substeps) world.world.setConstraintSolver(&solver);
      PackingCollisionAlgorithm::prepareWorld(world.world);
      world.world.setGravity(
          btVector3(btScalar(kGravity * std::sin(kSlope)), 0, btScalar(-kGravity * std::cos(kSlope))));
      world.add(makePackedShape(*makeBox({12, 2, 1}), 256), 0, btVector3(5, 0, btScalar(-0.5)))
          .setFriction(1);
      const auto shape = makePackedShape(*makeSolid(disc, "disc"), 256);
      btRigidBody& body = world.add(shape, 1, btVector3(0, 0, 0));
      body.setFriction(btScalar(kFriction));
      const btQuaternion upright(btVector3(1, 0, 0), SIMD_HALF_PI);
      body.setWorldTransform(shape->bodyTransform(btTransform(upright, btVector3(0, 0, btScalar(kOuter)))));
      btScalar highest = 0;
      for (int i = 0; i < int(kSeconds * rate); ++i) {
        world.run(1 / rate, 1 / rate);
        highest = btMax(highest, body.getWorldTransform().getOrigin().z());
      }
      const double speed = kGravity * (std::sin(kSlope) - kFriction * std::cos(kSlope)) * kSeconds;
      EXPECT_NEAR(body.getLinearVelocity().x(), speed, 0.015 * speed) << substeps << rate;
      EXPECT_LT(highest, kOuter + 0.002) << substeps << rate;
      world.world.setConstraintSolver(&world.solver);
    }
  }
}

}  // namespace
}  // namespace innersphere::test
