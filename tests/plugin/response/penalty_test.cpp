// Penalty forces: conservation, rest, friction, restitution, and the longest stable step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "innersphere/error.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kGravity = 9.81;

ContactOptions penalty(double stiffness, double damping) {
  ContactOptions options;
  options.response = Response::penalty;
  options.stiffness = stiffness;
  options.damping = damping;
  options.estimator = Estimator::raw;
  return options;
}

btRigidBody& awake(btRigidBody& body) {
  body.setActivationState(DISABLE_DEACTIVATION);
  return body;
}

/// The potential of a ball with depth h in a plane under the force k V: k pi (r h^3 / 3 - h^4 / 12).
double capPotential(double k, double r, double h) {
  return h > 0 ? k * M_PI * (r * h * h * h / 3 - h * h * h * h / 12) : 0;
}

// Leap-frog velocities are half a step behind: the error of the energy is of second order, and does not grow.
TEST(Penalty, ABouncingBallKeepsItsEnergy) {
  constexpr double kStiffness = 2e4, kRadius = 0.5, kHeight = 0.3;
  double errors[2];
  for (int fine = 0; fine < 2; ++fine) {
    const double dt = fine ? 1.0 / 4000 : 1.0 / 2000;
    TestWorld world(penalty(kStiffness, 0));
    world.addFloor();
    btRigidBody& ball =
        awake(world.add(makeShape(singleBall(kRadius)), 1, btVector3(0, 0, btScalar(kRadius + kHeight))));
    double top = 0;
    int bounces = 0;
    double before = -1, worst = 0;
    for (int i = 0; bounces < 20; ++i) {
      ASSERT_LT(i, 60 / dt);
      world.run(dt, dt);
      const double speed = ball.getLinearVelocity().z();
      top = std::max(top, double(ball.getWorldTransform().getOrigin().z()) - kRadius);
      if (before < 0 && speed >= 0) {
        if (bounces > 0) worst = std::max(worst, std::fabs(top / kHeight - 1));
        top = 0;
        ++bounces;
      }
      before = speed;
    }
    errors[fine] = worst;
  }
  EXPECT_LT(errors[0], 0.02);
  EXPECT_LT(errors[1], 0.01);
}

TEST(Penalty, TheDepthOfABounceHasTheEnergyOfTheFall) {
  constexpr double kStiffness = 2e4, kRadius = 0.5, kHeight = 0.3;
  TestWorld world(penalty(kStiffness, 0));
  world.addFloor();
  btRigidBody& ball =
      awake(world.add(makeShape(singleBall(kRadius)), 1, btVector3(0, 0, btScalar(kRadius + kHeight))));
  double lowest = kHeight;
  for (int i = 0; i < 4000; ++i) {
    world.run(1e-4, 1e-4);
    lowest = std::min(lowest, double(ball.getWorldTransform().getOrigin().z()) - kRadius);
  }
  ASSERT_LT(lowest, -0.02);
  EXPECT_NEAR(capPotential(kStiffness, kRadius, -lowest), kGravity * (kHeight - lowest),
              0.01 * kGravity * (kHeight - lowest));
}

TEST(Penalty, PackingsKeepMomentumAndEnergyInACollision) {
  TestWorld world(penalty(3e5, 0));
  world.world.setGravity(btVector3(0, 0, 0));
  const auto shape = makeShape(latticeBox({1, 0.6, 0.4}, 6));
  btRigidBody& a = awake(world.add(shape, 2, btVector3(0, 0, 0), btQuaternion(btVector3(1, 2, 3), 1)));
  btRigidBody& b = awake(
      world.add(shape, 3, btVector3(2, btScalar(0.3), btScalar(0.1)), btQuaternion(btVector3(0, 2, 1), 2)));
  for (btRigidBody* body : {&a, &b}) body->setFriction(0);
  b.setLinearVelocity(btVector3(-2, 0, 0));
  const auto angular = [](const btRigidBody& body) {
    const btVector3 spin = body.getInvInertiaTensorWorld().inverse() * body.getAngularVelocity();
    return spin + body.getWorldTransform().getOrigin().cross(body.getLinearVelocity() / body.getInvMass());
  };
  const btVector3 turn = angular(a) + angular(b);
  const double energy = world.kineticEnergy();
  double least = energy;
  for (int i = 0; i < 8000; ++i) {
    world.run(2e-4, 2e-4);
    least = std::min(least, world.kineticEnergy());
  }
  ASSERT_LT(least, 0.9 * energy);  // they met
  const btVector3 momentum = a.getLinearVelocity() * 2 + b.getLinearVelocity() * 3;
  EXPECT_NEAR(momentum.x(), -6, 1e-4);
  EXPECT_NEAR(momentum.y(), 0, 1e-4);
  EXPECT_NEAR(momentum.z(), 0, 1e-4);
  EXPECT_LT((angular(a) + angular(b) - turn).length(), 2e-3 * turn.length());
  EXPECT_NEAR(world.kineticEnergy(), energy, 0.01 * energy);
}

TEST(Penalty, RestsWhereVolumeBalancesTheWeight) {
  constexpr int kCells = 8;
  constexpr double kRadius = 0.5 / kCells, kDepth = 0.02;
  const double volume = kCells * kCells * M_PI * kDepth * kDepth * (3 * kRadius - kDepth) / 3;
  TestWorld world(penalty(kGravity / volume, 1));
  world.addFloor();
  btRigidBody& cube =
      awake(world.add(makeShape(latticeBox({1, 1, 1}, kCells)), 1, btVector3(0, 0, btScalar(0.5))));
  world.run(4, 1.0 / 240);
  EXPECT_NEAR(0.5 - cube.getWorldTransform().getOrigin().z(), kDepth, 0.01 * kDepth);
  EXPECT_LT(cube.getLinearVelocity().length(), 1e-4);
  EXPECT_LT(tiltDegrees(cube), 0.1);
  // Reported contacts carry the weight.
  double impulse = 0;
  for (int i = 0; i < world.dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *world.dispatcher.getManifoldByIndexInternal(i);
    for (int k = 0; k < manifold.getNumContacts(); ++k)
      impulse += manifold.getContactPoint(k).getAppliedImpulse();
  }
  EXPECT_NEAR(impulse * 240, kGravity, 0.02 * kGravity);
}

TEST(Penalty, DefaultStiffnessRestsAtUsualSteps) {
  for (const double mass : {0.01, 1.0, 100.0}) {
    for (const double dt : {1.0 / 60, 1.0 / 240}) {
      TestWorld world(penalty(0, 1));
      world.addFloor();
      const auto shape = makeShape(latticeBox({1, 1, 1}, 8));
      world.add(shape, mass, btVector3(0, 0, btScalar(0.5)));
      btRigidBody& top = world.add(shape, mass, btVector3(0, 0, btScalar(1.5)));
      world.run(4, dt);
      EXPECT_LT(top.getLinearVelocity().length(), 0.02) << mass << " kg, " << dt << " s";
      EXPECT_LT(tiltDegrees(top), 1) << mass << " kg, " << dt << " s";
    }
  }
}

TEST(Penalty, RestitutionSetsTheRebound) {
  for (const double e : {0.3, 0.6, 0.9}) {
    TestWorld world(penalty(2e4, 1));
    world.world.setGravity(btVector3(0, 0, 0));
    world.addFloor().setRestitution(1);
    btRigidBody& cube =
        awake(world.add(makeShape(latticeBox({1, 1, 1}, 16)), 1, btVector3(0, 0, btScalar(0.51))));
    cube.setRestitution(btScalar(e));
    cube.setLinearVelocity(btVector3(0, 0, -1));
    world.run(0.5, 1e-4);
    EXPECT_NEAR(cube.getLinearVelocity().z(), e, 0.1) << e;
  }
}

TEST(Penalty, FrictionHoldsOnASlopeAndSlidesAboveItsAngle) {
  constexpr double kFriction = 0.5;
  for (const double slope : {0.4, 0.6}) {  // tangents
    TestWorld world(penalty(2e4, 1));
    const double angle = std::atan(slope);
    world.world.setGravity(
        btVector3(btScalar(kGravity * std::sin(angle)), 0, btScalar(-kGravity * std::cos(angle))));
    world.addFloor().setFriction(1);
    btRigidBody& cube =
        awake(world.add(makeShape(latticeBox({1, 1, 0.5}, 8)), 1, btVector3(0, 0, btScalar(0.25))));
    cube.setFriction(btScalar(kFriction));
    world.run(1, 1.0 / 480);
    const double before = cube.getLinearVelocity().x();
    world.run(1, 1.0 / 480);
    const double expected = std::max(0.0, kGravity * (std::sin(angle) - kFriction * std::cos(angle)));
    EXPECT_NEAR(cube.getLinearVelocity().x() - before, expected, 0.02 * kGravity) << slope;
    if (expected == 0) {
      EXPECT_LT(std::fabs(cube.getLinearVelocity().x()), 1e-3);
    }
  }
}

TEST(Penalty, RollingFrictionStopsABall) {
  constexpr double kRadius = 0.5, kRolling = 0.05, kSpeed = 1;
  TestWorld world(penalty(1e5, 1));
  world.addFloor().setFriction(1);
  btRigidBody& ball =
      awake(world.add(makeShape(singleBall(kRadius)), 1, btVector3(0, 0, btScalar(kRadius - 0.008))));
  ball.setFriction(1);
  ball.setRollingFriction(btScalar(kRolling));
  ball.setLinearVelocity(btVector3(kSpeed, 0, 0));
  ball.setAngularVelocity(btVector3(0, btScalar(kSpeed / kRadius), 0));
  // The torque mu N about the point of contact slows it by (mu g / R) / (1 + 2/5).
  const double slowing = kRolling * kGravity / kRadius / 1.4;
  world.run(0.5, 1e-3);
  EXPECT_NEAR(ball.getLinearVelocity().x(), kSpeed - 0.5 * slowing, 0.05);
  world.run(2, 1e-3);
  EXPECT_LT(ball.getLinearVelocity().length(), 1e-3);
}

TEST(Penalty, ActsOnceAStepHoweverOftenPairsAreDispatched) {
  const auto fall = [](bool again) {
    TestWorld world(penalty(2e4, 0));
    world.addFloor();
    btRigidBody& ball = awake(world.add(makeShape(singleBall(0.5)), 1, btVector3(0, 0, btScalar(0.6))));
    for (int i = 0; i < 200; ++i) {
      world.run(1e-3, 1e-3);
      if (again) {
        world.world.performDiscreteCollisionDetection();
        world.world.performDiscreteCollisionDetection();
      }
    }
    return ball.getWorldTransform().getOrigin().z();
  };
  EXPECT_EQ(fall(false), fall(true));
}

TEST(Penalty, SubstepsOfOneCallDoNotAddUp) {
  const auto fall = [](int substeps) {
    TestWorld world(penalty(2e4, 0));
    world.addFloor();
    btRigidBody& ball = awake(world.add(makeShape(singleBall(0.5)), 1, btVector3(0, 0, btScalar(0.55))));
    constexpr btScalar kStep = btScalar(1.0 / 1024);
    for (int i = 0; i < 200; i += substeps)
      world.world.stepSimulation(kStep * btScalar(substeps), substeps, kStep);
    return ball.getWorldTransform().getOrigin().z();
  };
  EXPECT_NEAR(fall(1), fall(10), 1e-5);
}

TEST(Penalty, QueriesDoNotPush) {
  TestWorld world(penalty(2e4, 0));
  world.world.setGravity(btVector3(0, 0, 0));
  world.addFloor();
  btRigidBody& ball = awake(world.add(makeShape(singleBall(0.5)), 1, btVector3(0, 0, btScalar(0.45))));
  struct Count : btCollisionWorld::ContactResultCallback {
    btScalar addSingleResult(btManifoldPoint&, const btCollisionObjectWrapper*, int, int,
                             const btCollisionObjectWrapper*, int, int) override {
      ++count;
      return 0;
    }
    int count = 0;
  } callback;
  world.world.contactTest(&ball, callback);
  EXPECT_GT(callback.count, 0);
  EXPECT_EQ(ball.getLinearVelocity(), btVector3(0, 0, 0));
}

TEST(Penalty, BodiesWithoutContactResponseAreNotPushed) {
  TestWorld world(penalty(2e4, 0));
  world.world.setGravity(btVector3(0, 0, 0));
  world.addFloor();
  btRigidBody& ball = awake(world.add(makeShape(singleBall(0.5)), 1, btVector3(0, 0, btScalar(0.45))));
  ball.setCollisionFlags(ball.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
  world.run(0.1);
  EXPECT_EQ(ball.getLinearVelocity(), btVector3(0, 0, 0));
  EXPECT_GT(world.contactCount(), 0);
}

}  // namespace
}  // namespace innersphere::test
