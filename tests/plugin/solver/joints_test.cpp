// Constraints against closed forms, at 60 steps a second.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "solver/solver_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kPi = 3.14159265358979324;

/// The time between two passages through the lowest place in the same direction [s], interpolated.
double periodOf(SolverWorld& world, const btRigidBody& body, int swings) {
  double first = -1, last = -1, time = 0, before = body.getWorldTransform().getOrigin().x();
  for (int passed = 0; passed <= swings; time += 1.0 / 60) {
    world.step();
    const double now = body.getWorldTransform().getOrigin().x();
    if (before < 0 && now >= 0) {
      last = time + (1.0 / 60) * before / (before - now);
      if (passed++ == 0) first = last;
    }
    before = now;
    if (time > 60) return -1;
  }
  return (last - first) / swings;
}

TEST(SubstepJoints, APendulumSwingsAsItsEllipticIntegralSays) {
  for (const bool hinge : {false, true}) {
    SolverWorld world;
    constexpr double kLength = 1, kAmplitude = 1;
    btRigidBody& bob =
        world.addBox(btVector3(0.1f, 0.1f, 0.1f), 1,
                     btVector3(btScalar(std::sin(kAmplitude)), 0, btScalar(-std::cos(kAmplitude))));
    const btVector3 pivot = -bob.getWorldTransform().getOrigin();
    if (hinge)
      world.join<btHingeConstraint>(bob, pivot, btVector3(0, 1, 0));
    else
      world.join<btPoint2PointConstraint>(bob, pivot);
    const double inertia = kLength * kLength + 1 / bob.getInvInertiaDiagLocal().y();
    const double expected =
        4 * std::comp_ellint_1(std::sin(kAmplitude / 2)) * std::sqrt(inertia / (kGravity * kLength));
    const double before = world.energy();
    EXPECT_NEAR(periodOf(world, bob, 5), expected, 1e-3 * expected) << hinge;
    EXPECT_NEAR(world.energy(), before, 0.005 * kGravity * kLength) << hinge;
    EXPECT_NEAR(bob.getWorldTransform().getOrigin().length(), kLength, 1e-4) << hinge;
  }
}

TEST(SubstepJoints, ADoublePendulumKeepsItsEnergy) {
  SolverWorld world;
  btRigidBody& upper = world.addBox(btVector3(0.5f, 0.05f, 0.05f), 1, btVector3(0.5f, 0, 0));
  btRigidBody& lower = world.addBox(btVector3(0.5f, 0.05f, 0.05f), 1, btVector3(1.5f, 0, 0));
  world.join<btHingeConstraint>(upper, btVector3(-0.5f, 0, 0), btVector3(0, 1, 0));
  world.join<btHingeConstraint>(upper, lower, btVector3(0.5f, 0, 0), btVector3(-0.5f, 0, 0),
                                btVector3(0, 1, 0), btVector3(0, 1, 0));
  const double before = world.energy();
  double most = 0;
  for (int i = 0; i < 600; ++i) {
    world.step();
    most = std::max(most, std::fabs(world.energy() - before));
  }
  EXPECT_LT(most, 0.02 * 2 * kGravity);  // of a fall of both by a metre
}

TEST(SubstepJoints, AHingeMotorTurnsWithItsTorqueUpToItsSpeed) {
  SolverWorld world;
  world.world.setGravity(btVector3(0, 0, 0));
  btRigidBody& wheel = world.addBox(btVector3(0.5f, 0.1f, 0.5f), 2, btVector3(0, 0, 0));
  auto& hinge = world.join<btHingeConstraint>(wheel, btVector3(0, 0, 0), btVector3(0, 1, 0));
  constexpr btScalar kImpulse = btScalar(0.01), kSpeed = 2;  // of a step
  hinge.enableAngularMotor(true, kSpeed, kImpulse);
  const double gain = kImpulse * wheel.getInvInertiaDiagLocal().y();  // [rad/s] in a step
  world.run(0.5);
  EXPECT_NEAR(std::fabs(wheel.getAngularVelocity().y()), 30 * gain, 0.01 * 30 * gain);
  world.run(20);
  EXPECT_NEAR(std::fabs(wheel.getAngularVelocity().y()), kSpeed, 1e-3 * kSpeed);
}

TEST(SubstepJoints, AFastTopPrecessesAsItsMomentsSay) {
  SolverWorld world;
  constexpr double kArm = 0.5, kTilt = 0.5, kSpin = 200, kMass = 1, kAxial = 0.02, kAcross = 0.015;
  btRigidBody& top = world.add(std::make_unique<btSphereShape>(btScalar(0.1)), kMass, btVector3(0, 0, 0),
                               btVector3(kAcross, kAcross, kAxial));
  const btQuaternion tilt(btVector3(1, 0, 0), btScalar(kTilt));
  const btVector3 axis = quatRotate(tilt, btVector3(0, 0, 1));
  top.setWorldTransform(btTransform(tilt, axis * btScalar(kArm)));
  top.updateInertiaTensor();
  world.join<btPoint2PointConstraint>(top, btVector3(0, 0, -btScalar(kArm)));
  // Steady precession: about the pivot, A cos W^2 - C s W + m g l = 0, with s the spin about the axis.
  const double across = kAcross + kMass * kArm * kArm, c = std::cos(kTilt);
  const double linear = kAxial * kSpin;
  const double slow =
      (linear - std::sqrt(linear * linear - 4 * across * c * kMass * kGravity * kArm)) / (2 * across * c);
  const btVector3 spin = axis * btScalar(kSpin - slow * c) + btVector3(0, 0, btScalar(slow));
  top.setAngularVelocity(spin);
  top.setLinearVelocity(spin.cross(axis * btScalar(kArm)));
  double angle = 0, before = std::atan2(axis.x(), -axis.y());
  constexpr double kSeconds = 5;
  for (int i = 0; i < kSeconds * 60; ++i) {
    world.step();
    const btVector3 now = top.getWorldTransform().getOrigin();
    const double heading = std::atan2(now.x(), -now.y());
    angle += std::remainder(heading - before, 2 * kPi);
    before = heading;
  }
  EXPECT_NEAR(angle / kSeconds, slow, 0.01 * slow);
  EXPECT_NEAR(top.getWorldTransform().getOrigin().z(), kArm * c, 0.01 * kArm);
}

TEST(SubstepJoints, ARodThatWhirlsOnABallJointGainsNothing) {
  for (const btScalar rate : {20, 60, 120, 200}) {  // [rad/s]
    SolverWorld world;
    world.world.setGravity(btVector3(0, 0, 0));
    btRigidBody& rod = world.addBox(btVector3(0.025f, 0.025f, 0.5f), btScalar(0.1), btVector3(0, 0, 0));
    world.join<btPoint2PointConstraint>(rod, btVector3(0, 0, 0.5f));
    const btVector3 spin(rate, 0, btScalar(0.3) * rate);
    rod.setAngularVelocity(spin);
    rod.setLinearVelocity(spin.cross(btVector3(0, 0, -0.5f)));
    const auto energy = [&] {
      return world.energy() - double(rod.getMass() * kGravity * rod.getWorldTransform().getOrigin().z());
    };
    const double start = energy();
    for (int i = 0; i < 120; ++i) {
      world.step();
      ASSERT_LT(energy(), 1.001 * start) << rate << ", step " << i;
    }
  }
}

TEST(SubstepJoints, ASliderMovesAlongItsAxisUnderGravityOnly) {
  SolverWorld world;
  btRigidBody& carriage = world.addBox(btVector3(0.1f, 0.1f, 0.1f), 1, btVector3(0, 0, 0));
  // The axis of a slider is x of its frame: 30 degrees down.
  const btQuaternion down(btVector3(0, 1, 0), btScalar(kPi / 6));
  auto& slider = world.join<btSliderConstraint>(carriage, btTransform(down), true);
  slider.setLowerLinLimit(-100);
  slider.setUpperLinLimit(100);
  world.run(1);
  const btVector3 at = carriage.getWorldTransform().getOrigin();
  EXPECT_NEAR(at.length(), kGravity * 0.5 / 2, 0.01 * kGravity / 4);
  EXPECT_NEAR(at.z() / at.x(), -std::tan(kPi / 6), 1e-3);
}

TEST(SubstepJoints, LimitsHoldAndBreakAtTheirThreshold) {
  for (const bool breaks : {false, true}) {
    SolverWorld world;
    btRigidBody& arm = world.addBox(btVector3(0.5f, 0.1f, 0.1f), 1, btVector3(0.5f, 0, 0));
    auto& hinge = world.join<btHingeConstraint>(arm, btVector3(-0.5f, 0, 0), btVector3(0, 1, 0));
    hinge.setLimit(btScalar(-0.2), btScalar(0.2));
    hinge.enableFeedback(true);
    // At rest the joint bears the weight, m g dt in a step; falling it bears less than ten times as much.
    hinge.setBreakingImpulseThreshold(breaks ? btScalar(0.05) : BT_LARGE_FLOAT);
    world.run(3);
    EXPECT_EQ(hinge.isEnabled(), !breaks);
    if (!breaks) {
      EXPECT_NEAR(std::fabs(hinge.getHingeAngle()), 0.2, 0.005);
      // Bullet's hinge has a row only while its limit is passed: it falls for a substep when it is not.
      EXPECT_LT(arm.getAngularVelocity().length(), 1.5 * kGravity / 0.5 / 960);
    }
  }
}

TEST(SubstepJoints, WhatHangsFromAKinematicBodyGoesAlong) {
  SolverWorld world;
  btRigidBody& crane = world.addBox(btVector3(0.1f, 0.1f, 0.1f), 0, btVector3(0, 0, 2));
  crane.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  crane.setActivationState(DISABLE_DEACTIVATION);
  btRigidBody& load = world.addBox(btVector3(0.1f, 0.1f, 0.1f), 1, btVector3(0, 0, 1));
  world.join<btPoint2PointConstraint>(crane, load, btVector3(0, 0, -0.5f), btVector3(0, 0, 0.5f));
  for (int i = 0; i < 60; ++i) {
    btTransform place = crane.getWorldTransform();
    place.getOrigin() += btVector3(0, 0, btScalar(1) / 60);
    crane.setWorldTransform(place);
    world.step();
    EXPECT_EQ(crane.getWorldTransform(), place);
  }
  EXPECT_NEAR(load.getLinearVelocity().z(), 1, 1e-3);
  // Bullet takes the place that it is given for the one at the end of the step, and starts from there.
  EXPECT_NEAR(crane.getWorldTransform().getOrigin().z() - load.getWorldTransform().getOrigin().z(), 1,
              1.1 / 60);
}

/// A constraint of a user's own class: its body keeps its height.
class KeepsHeight : public btTypedConstraint {
 public:
  KeepsHeight(btRigidBody& body, btScalar height)
      : btTypedConstraint(D6_CONSTRAINT_TYPE, body), height_(height) {}
  void getInfo1(btConstraintInfo1* info) override {
    info->m_numConstraintRows = rows;
    info->nub = 0;
  }
  void getInfo2(btConstraintInfo2* info) override {
    for (int i = 0; i < rows; ++i) {
      info->m_J1linearAxis[i * info->rowskip + 2] = 1;
      info->m_constraintError[i * info->rowskip] =
          info->fps * info->erp * (height_ - m_rbA.getWorldTransform().getOrigin().z());
    }
  }
  void setParam(int, btScalar, int) override {}
  btScalar getParam(int, int) const override { return 0; }
  int rows = 1;

 private:
  btScalar height_;
};

TEST(SubstepJoints, ConstraintsOfTheUsersOwnAreSolved) {
  SolverWorld world;
  btRigidBody& ball = world.addBall(btScalar(0.1), 1, btVector3(0, 0, btScalar(0.9)));
  KeepsHeight& keeps = world.join<KeepsHeight>(ball, 1);
  ball.setLinearVelocity(btVector3(1, 0, 0));
  world.run(1);
  EXPECT_NEAR(ball.getWorldTransform().getOrigin().z(), 1, 1e-4);
  EXPECT_NEAR(ball.getWorldTransform().getOrigin().x(), 1, 1e-4);
  keeps.rows = 20;  // the same row many times is singular, and no harm
  world.run(1);
  EXPECT_NEAR(ball.getWorldTransform().getOrigin().z(), 1, 1e-4);
}

TEST(SubstepJoints, ALoadOnAChainOfHingesHolds) {
  SolverWorld world;
  btRigidBody* above = nullptr;
  constexpr int kLinks = 10;
  for (int i = 0; i < kLinks; ++i) {
    const bool load = i + 1 == kLinks;
    btRigidBody& link = world.addBox(btVector3(0.05f, 0.05f, 0.25f), load ? 100 : 1,
                                     btVector3(0, 0, btScalar(-0.25 - 0.5 * i)));
    if (above == nullptr)
      world.join<btPoint2PointConstraint>(link, btVector3(0, 0, 0.25f));
    else
      world.join<btPoint2PointConstraint>(*above, link, btVector3(0, 0, -0.25f), btVector3(0, 0, 0.25f));
    above = &link;
  }
  world.run(5);
  EXPECT_NEAR(above->getWorldTransform().getOrigin().z(), -0.25 - 0.5 * (kLinks - 1), 0.005);
  EXPECT_LT(above->getLinearVelocity().length(), 1e-3);
}

}  // namespace
}  // namespace innersphere::test
