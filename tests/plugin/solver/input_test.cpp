// SubstepSolver with input that is wrong, or large, or none: no crash, nothing that is no number goes on to
// others, and one message.
#include <cmath>
#include <functional>
#include <limits>
#include <thread>

#include <gtest/gtest.h>

#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include "capture_log.hpp"
#include "innersphere/error.hpp"
#include "solver/solver_world.hpp"

namespace innersphere::test {
namespace {

constexpr btScalar kInfinity = std::numeric_limits<btScalar>::infinity();
constexpr btScalar kNan = std::numeric_limits<btScalar>::quiet_NaN();
constexpr btScalar kHalf = btScalar(0.25);  // of a box's edge [m]

btRigidBody& addCube(SolverWorld& world, btScalar z) {
  return world.addBox(btVector3(kHalf, kHalf, kHalf), 1, btVector3(0, 0, z));
}

bool hasOnlyNumbers(const SolverWorld& world) {
  for (const btScalar x : world.motion()) {
    if (!std::isfinite(x)) return false;
  }
  return true;
}

TEST(SubstepInput, BodiesWithInfiniteVelocitiesOrForcesAreStoppedForAStep) {
  const std::function<void(btRigidBody&, const btVector3&)> spoils[] = {
      [](btRigidBody& body, const btVector3& bad) { body.setLinearVelocity(bad); },
      [](btRigidBody& body, const btVector3& bad) { body.setAngularVelocity(bad); },
      [](btRigidBody& body, const btVector3& bad) { body.applyCentralForce(bad); },
      [](btRigidBody& body, const btVector3& bad) { body.applyTorque(bad); }};
  for (const btScalar bad : {kInfinity, -kInfinity, kNan}) {
    for (const auto& spoil : spoils) {
      SolverWorld world;
      CaptureLog log;
      world.addFloor();
      btRigidBody& lower = addCube(world, kHalf);
      btRigidBody& upper = addCube(world, 3 * kHalf);
      world.join<btPoint2PointConstraint>(upper, world.addBall(btScalar(0.1), 1, btVector3(1, 0, 3 * kHalf)),
                                          btVector3(1, 0, 0), btVector3(0, 0, 0));
      world.run(0.2);
      EXPECT_EQ(log.messages.size(), 0u);
      spoil(upper, btVector3(0, bad, 0));
      world.step();
      EXPECT_TRUE(hasOnlyNumbers(world)) << bad;
      EXPECT_EQ(upper.getLinearVelocity(), btVector3(0, 0, 0)) << bad;
      spoil(upper, btVector3(0, bad, 0));
      world.run(0.5);  // the upper one tumbles down on it later
      EXPECT_TRUE(hasOnlyNumbers(world)) << bad;
      EXPECT_NEAR(lower.getWorldTransform().getOrigin().z(), kHalf, 0.001) << bad;
      ASSERT_EQ(log.messages.size(), 1u) << bad;
      const std::string name = "getWorldArrayIndex() " + std::to_string(upper.getWorldArrayIndex()) + " ";
      EXPECT_NE(log.messages[0].find(name), std::string::npos) << log.messages[0];
    }
  }
}

TEST(SubstepInput, ABodyNowhereTouchesNothing) {
  SolverWorld world;
  CaptureLog log;
  world.addFloor();
  const btRigidBody& lower = addCube(world, kHalf);
  btRigidBody& upper = addCube(world, 3 * kHalf);
  world.run(0.2);
  upper.getWorldTransform().getOrigin().setX(kNan);
  world.run(1);
  EXPECT_NEAR(lower.getWorldTransform().getOrigin().z(), kHalf, 0.001);
  EXPECT_EQ(upper.getLinearVelocity(), btVector3(0, 0, 0));
  EXPECT_EQ(log.messages.size(), 1u);
}

TEST(SubstepInput, ABeltOfNoSpeedAtAllCarriesNothing) {
  SolverWorld world;
  CaptureLog log;
  btRigidBody& belt = world.addSlab();
  belt.setLinearVelocity(btVector3(0, kNan, 0));
  belt.setUserIndex(77);
  const btRigidBody& box = addCube(world, kHalf);
  world.run(0.5);
  // It falls through: nothing pushes it.
  EXPECT_NEAR(box.getLinearVelocity().z(), -kGravity / 2, 0.01 * kGravity);
  ASSERT_EQ(log.messages.size(), 1u);
  EXPECT_NE(log.messages[0].find("getUserIndex() 77"), std::string::npos) << log.messages[0];
}

TEST(SubstepInput, PointsWithoutNumbersAreLeftOut) {
  const std::function<void(btManifoldPoint&)> spoils[] = {
      [](btManifoldPoint& p) { p.m_normalWorldOnB = btVector3(kNan, 0, 0); },
      [](btManifoldPoint& p) { p.m_positionWorldOnA.setX(kInfinity); },
      [](btManifoldPoint& p) { p.setDistance(kNan); },
      [](btManifoldPoint& p) { p.m_combinedFriction = kNan; },
      [](btManifoldPoint& p) { p.m_combinedRestitution = kInfinity; },
      [](btManifoldPoint& p) { p.m_combinedRollingFriction = kNan; },
      [](btManifoldPoint& p) { p.m_combinedSpinningFriction = kNan; }};
  for (const auto& spoil : spoils) {
    SolverWorld world;
    CaptureLog log;
    world.addFloor();
    btRigidBody& box = addCube(world, kHalf);
    world.run(0.2);
    btPersistentManifold* manifold = world.dispatcher.getManifoldByIndexInternal(0);
    spoil(manifold->getContactPoint(0));
    btCollisionObject* body = &box;
    world.solver.solveGroup(&body, 1, &manifold, 1, nullptr, 0, btContactSolverInfo(), nullptr,
                            &world.dispatcher);
    EXPECT_TRUE(hasOnlyNumbers(world));
    EXPECT_EQ(log.messages.size(), 1u);
  }
}

TEST(SubstepInput, ImpulsesThatAreNoNumbersAreForgotten) {
  SolverWorld world;
  world.addFloor();
  const btRigidBody& box = addCube(world, kHalf);
  world.run(0.2);
  btManifoldPoint& point = world.dispatcher.getManifoldByIndexInternal(0)->getContactPoint(0);
  for (btScalar* impulse : {&point.m_appliedImpulse, &point.m_prevRHS, &point.m_appliedImpulseLateral1}) {
    *impulse = kNan;
    world.run(0.5);
    EXPECT_NEAR(box.getWorldTransform().getOrigin().z(), kHalf, 0.001);
  }
}

TEST(SubstepInput, BodiesWithoutInertiaMoveButDoNotTurn) {
  SolverWorld world;
  world.addFloor();
  const auto withoutInertia = [&](const btVector3& place) -> btRigidBody& {
    btRigidBody& box = world.addBox(btVector3(kHalf, kHalf, kHalf), 1, place);
    box.setMassProps(1, btVector3(0, 0, 0));
    box.updateInertiaTensor();
    return box;
  };
  const btRigidBody& box = withoutInertia(btVector3(0, 0, 1));
  btRigidBody &left = withoutInertia(btVector3(3, 0, 1)), &right = withoutInertia(btVector3(4, 0, 1));
  world.join<btHingeConstraint>(left, right, btVector3(0.5f, 0, 0), btVector3(-0.5f, 0, 0),
                                btVector3(0, 1, 0), btVector3(0, 1, 0));
  world.run(2);
  for (const btRigidBody* body : {&box, static_cast<const btRigidBody*>(&left)}) {
    EXPECT_NEAR(body->getWorldTransform().getOrigin().z(), kHalf, 0.001);
    EXPECT_EQ(body->getAngularVelocity().length(), 0);
  }
}

TEST(SubstepInput, RowsThatSayTheSameAreNoHarm) {
  SolverWorld world;
  CaptureLog log;
  btRigidBody& bob = world.addBall(btScalar(0.1), 1, btVector3(1, 0, 0));
  const btVector3 pivot(-1, 0, 0), axis(0, 1, 0);
  // The same joint in several ways: 5 + 5 + 3 rows of the same 5.
  world.join<btHingeConstraint>(bob, pivot, axis);
  world.join<btHingeConstraint>(bob, pivot, axis);
  world.join<btPoint2PointConstraint>(bob, pivot);
  const double before = world.energy();
  world.run(5);
  EXPECT_NEAR(bob.getWorldTransform().getOrigin().length(), 1, 1e-3);
  EXPECT_NEAR(world.energy(), before, 0.02 * kGravity);
  EXPECT_EQ(log.messages.size(), 0u);
}

TEST(SubstepInput, AHingeWithoutAnAxisIsLeftOut) {
  SolverWorld world;
  CaptureLog log;
  btRigidBody& bob = world.addBall(btScalar(0.1), 1, btVector3(1, 0, 0));
  world.join<btHingeConstraint>(bob, btVector3(-1, 0, 0), btVector3(kNan, 0, 0));
  const btRigidBody& other = world.addBall(btScalar(0.1), 1, btVector3(0, 5, 0));
  world.run(1);
  EXPECT_TRUE(hasOnlyNumbers(world));
  EXPECT_NEAR(other.getLinearVelocity().z(), -kGravity, 0.01 * kGravity);
  EXPECT_EQ(log.messages.size(), 1u);
}

/// Of a user's own class, with rows that are no numbers, and as many as it likes.
class Nonsense : public btTypedConstraint {
 public:
  explicit Nonsense(btRigidBody& body) : btTypedConstraint(D6_CONSTRAINT_TYPE, body) {}
  void getInfo1(btConstraintInfo1* info) override {
    info->m_numConstraintRows = rows;
    if (grows) rows += 5;
    info->nub = 0;
  }
  void getInfo2(btConstraintInfo2* info) override { write(info); }
  void setParam(int, btScalar, int) override {}
  btScalar getParam(int, int) const override { return 0; }
  std::function<void(btConstraintInfo2*)> write = [](btConstraintInfo2*) {};
  int rows = 1;
  bool grows = false;
};

TEST(SubstepInput, RowsOfAUsersConstraintThatAreNoNumbersAreLeftOut) {
  using Info = btTypedConstraint::btConstraintInfo2;
  const std::function<void(Info*)> spoils[] = {[](Info* info) { info->m_J1linearAxis[2] = kNan; },
                                               [](Info* info) { info->m_J1angularAxis[0] = kInfinity; },
                                               [](Info* info) { info->m_constraintError[0] = kNan; },
                                               [](Info* info) { info->cfm[0] = kInfinity; },
                                               [](Info* info) { info->m_lowerLimit[0] = kNan; },
                                               [](Info* info) { info->m_upperLimit[0] = kNan; }};
  for (const auto& spoil : spoils) {
    SolverWorld world;
    CaptureLog log;
    btRigidBody& ball = world.addBall(btScalar(0.1), 1, btVector3(0, 0, 1));
    Nonsense& constraint = world.join<Nonsense>(ball);
    btJointFeedback feedback;
    constraint.setJointFeedback(&feedback);
    constraint.write = [&](Info* info) {
      info->m_J1linearAxis[2] = 1;
      spoil(info);
    };
    world.run(0.5);
    EXPECT_NEAR(ball.getLinearVelocity().z(), -kGravity / 2, 0.001);
    EXPECT_EQ(feedback.m_appliedForceBodyA, btVector3(0, 0, 0));
    EXPECT_EQ(log.messages.size(), 1u);
  }
}

TEST(SubstepInput, AUsersConstraintMayHaveAnyNumberOfRows) {
  for (const int rows : {-3, 0, 7, 100}) {
    for (const bool grows : {false, true}) {
      SolverWorld world;
      Nonsense& constraint = world.join<Nonsense>(world.addBall(btScalar(0.1), 1, btVector3(0, 0, 1)));
      constraint.rows = rows;
      constraint.grows = grows;
      // All rows hold it where it is.
      constraint.write = [](btTypedConstraint::btConstraintInfo2* info) { info->m_J1linearAxis[2] = 1; };
      world.run(0.1);
      EXPECT_TRUE(hasOnlyNumbers(world)) << rows;
      if (!grows) {
        EXPECT_NEAR(world.bodies[0]->getLinearVelocity().z(), rows > 0 ? 0 : -kGravity / 10, 1e-4) << rows;
      }
    }
  }
}

TEST(SubstepInput, StepsOfNothingOrNoTimeAtAllDoNothing) {
  SolverWorld world;
  btRigidBody& box = addCube(world, 1);
  box.setLinearVelocity(btVector3(1, 0, 0));
  btCollisionObject* body = &box;
  btContactSolverInfo info;
  for (const btScalar step : {btScalar(0), btScalar(-1), kInfinity, kNan}) {
    info.m_timeStep = step;
    world.solver.solveGroup(&body, 1, nullptr, 0, nullptr, 0, info, nullptr, &world.dispatcher);
    EXPECT_EQ(box.getWorldTransform().getOrigin(), btVector3(0, 0, 1));
    EXPECT_EQ(box.getLinearVelocity(), btVector3(1, 0, 0));
  }
  world.world.stepSimulation(0, 0);
  EXPECT_EQ(box.getLinearVelocity(), btVector3(1, 0, 0));
  world.solver.solveGroup(nullptr, 0, nullptr, 0, nullptr, 0, btContactSolverInfo(), nullptr,
                          &world.dispatcher);
}

TEST(SubstepInput, ManifoldsWithoutPointsPushNothing) {
  SolverWorld world;
  btRigidBody &lower = addCube(world, 0), &upper = addCube(world, 2 * kHalf);
  btPersistentManifold empty(&lower, &upper, 0, btScalar(0.02), btScalar(0.02));
  btPersistentManifold* manifolds[] = {&empty, &empty};
  btCollisionObject* bodies[] = {&lower, &upper};
  world.solver.solveGroup(bodies, 2, manifolds, 2, nullptr, 0, btContactSolverInfo(), nullptr,
                          &world.dispatcher);
  EXPECT_EQ(lower.getLinearVelocity(), btVector3(0, 0, 0));
}

TEST(SubstepInput, AMillionPointsCarryWhatLiesOnThem) {
  // Every manifold comes a hundred times: 2,500 boxes lie on 400 points each.
  constexpr int kAcross = 50, kTimes = 100, kPoints = 4;
  constexpr btScalar kSpeed = btScalar(0.1);
  SolverWorld world(SubstepOptions{1});
  btRigidBody& floor = world.addFloor();
  std::vector<btCollisionObject*> bodies;
  std::vector<std::unique_ptr<btPersistentManifold>> made;
  std::vector<btPersistentManifold*> manifolds;
  for (int i = 0; i < kAcross * kAcross; ++i) {
    const btVector3 place(btScalar(i % kAcross), btScalar(i / kAcross), kHalf);
    btRigidBody& box = world.addBox(btVector3(kHalf, kHalf, kHalf), 1, place);
    box.setLinearVelocity(btVector3(0, 0, -kSpeed));
    bodies.push_back(&box);
    made.push_back(std::make_unique<btPersistentManifold>(&box, &floor, 0, btScalar(0.02), btScalar(0.02)));
    for (int k = 0; k < kPoints; ++k) {
      const btVector3 corner(k % 2 != 0 ? kHalf : -kHalf, k / 2 != 0 ? kHalf : -kHalf, -kHalf);
      btManifoldPoint point(corner, place + corner, btVector3(0, 0, 1), 0);
      point.m_positionWorldOnA = point.m_positionWorldOnB = place + corner;
      point.m_combinedFriction = btScalar(0.5);
      made.back()->addManifoldPoint(point);
    }
    for (int k = 0; k < kTimes; ++k) manifolds.push_back(made.back().get());
  }
  ASSERT_EQ(manifolds.size() * kPoints, 1000000u);
  world.solver.solveGroup(bodies.data(), static_cast<int>(bodies.size()), manifolds.data(),
                          static_cast<int>(manifolds.size()), nullptr, 0, btContactSolverInfo(), nullptr,
                          &world.dispatcher);
  for (const btCollisionObject* body : bodies) {
    // One pass over them.
    ASSERT_LT(btRigidBody::upcast(body)->getLinearVelocity().length(), kSpeed / 20);
  }
}

TEST(SubstepInput, OneSolverServesTwoWorlds) {
  SolverWorld first, second, alone;
  second.world.setConstraintSolver(&first.solver);
  for (SolverWorld* world : {&first, &second, &alone}) fill(*world, 2, 2);
  for (int i = 0; i < 60; ++i) {
    first.step();
    second.step();
    alone.step();
  }
  EXPECT_EQ(first.motion(), alone.motion());
  EXPECT_EQ(second.motion(), alone.motion());
}

TEST(SubstepInput, WorldsMayStepAtTheSameTime) {
  for (const bool shared : {false, true}) {
    CaptureLog log;
    SolverWorld first, second, alone;
    if (shared) second.world.setConstraintSolver(&first.solver);
    for (SolverWorld* world : {&first, &second, &alone}) fill(*world, 4, 3);
    std::thread other([&] { second.run(0.5); });
    first.run(0.5);
    other.join();
    alone.run(0.5);
    EXPECT_EQ(first.motion(), alone.motion()) << shared;
    EXPECT_EQ(second.motion(), alone.motion()) << shared;
    EXPECT_EQ(log.messages.size(), 0u) << shared;
  }
}

TEST(SubstepInput, AMultiBodyWorldIsNamed) {
  CaptureLog log;
  SolverWorld parts;
  btMultiBodyConstraintSolver own;
  btMultiBodyDynamicsWorld world(&parts.dispatcher, &parts.broadphase, &own, &parts.configuration);
  world.setConstraintSolver(&parts.solver);
  for (int i = 0; i < 3; ++i) world.stepSimulation(btScalar(1) / 60, 0);
  ASSERT_EQ(log.messages.size(), 1u);
  EXPECT_NE(log.messages[0].find("btMultiBodyConstraintSolver"), std::string::npos);
  parts.world.stepSimulation(btScalar(1) / 60, 0);
  EXPECT_EQ(log.messages.size(), 1u);
}

TEST(SubstepInput, OptionsOutOfRangeAreErrors) {
  for (const SubstepOptions& options :
       {SubstepOptions{-1}, SubstepOptions{1001}, SubstepOptions{0, 0}, SubstepOptions{0, kNan},
        SubstepOptions{0, btScalar(0.001), 0}, SubstepOptions{0, btScalar(0.001), btScalar(0.001), 0}})
    EXPECT_THROW(SubstepSolver{options}, Error);
}

}  // namespace
}  // namespace innersphere::test
