// Contacts under SubstepSolver, most of Bullet's own shapes, against closed forms, at 60 steps a second.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>

#include "solver/contact_rows.hpp"
#include "solver/point_curvature.hpp"
#include "solver/solver_world.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr btScalar kHalf = btScalar(0.25);  // of a box's edge [m]
constexpr double kStep = 1.0 / 60;

btRigidBody& addCube(SolverWorld& world, btScalar mass, btScalar z) {
  return world.addBox(btVector3(kHalf, kHalf, kHalf), mass, btVector3(0, 0, z));
}

TEST(SubstepContacts, TenBoxesStandForHalfAMinute) {
  SolverWorld world;
  world.addFloor();
  for (int i = 0; i < 10; ++i) addCube(world, 125, (2 * i + 1) * kHalf);
  world.run(30);
  for (int i = 0; i < 10; ++i) {
    const btVector3 from(0, 0, (2 * i + 1) * kHalf);
    EXPECT_LT(world.bodies[i + 1]->getWorldTransform().getOrigin().distance(from), 0.003) << i;
  }
}

TEST(SubstepContacts, HeavyBoxesRestOnLightOnes) {
  for (const btScalar ratio : {10, 100, 1000}) {
    SolverWorld world;
    world.addFloor();
    addCube(world, 1, kHalf);
    const btRigidBody& upper = addCube(world, ratio, 3 * kHalf);
    world.run(5);
    EXPECT_NEAR(upper.getWorldTransform().getOrigin().z(), 3 * kHalf, 0.005 * 2 * kHalf) << ratio;
  }
}

TEST(SubstepContacts, WhatLandsOnSomethingLighterStops) {
  for (const btScalar ratio : {1, 3, 10}) {
    constexpr btScalar kRadius = btScalar(0.2), kDeep = btScalar(1e-5);  // or Bullet does not see it
    SolverWorld world;
    world.world.setGravity(btVector3(0, 0, 0));
    world.addFloor();
    world.addBall(kRadius, 1, btVector3(0, 0, kRadius));
    btRigidBody& upper = world.addBall(kRadius, ratio, btVector3(0, 0, 3 * kRadius - kDeep));
    upper.setLinearVelocity(btVector3(0, 0, -1));
    world.step(btScalar(1) / 240);  // before all is driven apart again
    // All are hard.
    const btScalar deepest = world.solver.options().depth * 2 * kRadius;
    EXPECT_GT(upper.getWorldTransform().getOrigin().z(), 3 * kRadius - deepest) << ratio;
  }
}

TEST(SubstepContacts, WhatIsDeepInANotchIsNotThrownOut) {
  constexpr btScalar kRadius = btScalar(0.5), kDeep = btScalar(0.1);
  for (const int degrees : {30, 45, 60}) {
    SolverWorld world;
    world.world.setGravity(btVector3(0, 0, 0));
    const btScalar slope = btScalar(degrees) * SIMD_RADS_PER_DEG;
    for (const btScalar side : {-1, 1}) {
      const btVector3 normal(side * btSin(slope), 0, btCos(slope));
      world.add(std::make_unique<btStaticPlaneShape>(normal, btScalar(0)), 0, btVector3(0, 0, 0));
    }
    btRigidBody& ball = world.addBall(kRadius, 1, btVector3(0, 0, (kRadius - kDeep) / btCos(slope)));
    world.run(2);
    EXPECT_GT(ball.getWorldTransform().getOrigin().z() * btCos(slope), kRadius - btScalar(0.001)) << degrees;
    // What drives it apart is as fast as half its size in a second, on each side.
    EXPECT_LT(ball.getLinearVelocity().length(), btScalar(0.5) * kRadius) << degrees;
  }
}

/// However slowly bodies may be driven apart, they bear more the deeper they are: a box of 0.3 m under more
/// than some 400 times its weight sank on and on, by 1 mm a step.
TEST(SubstepContacts, WhatIsHeavilyLoadedSinksInProportion) {
  constexpr double kHalf = 0.15, kMass = 1;
  std::vector<double> depths;
  for (const double weights : {200.0, 400.0, 800.0}) {
    SolverWorld world;
    world.addSlab();
    btRigidBody& box = world.addBox(btVector3(kHalf, kHalf, kHalf), kMass, btVector3(0, 0, kHalf));
    double before = 0;
    for (int i = 0; i < 60; ++i) {
      before = box.getWorldTransform().getOrigin().z();
      box.applyCentralForce(btVector3(0, 0, btScalar(-(weights - 1) * kMass * kGravity)));
      world.step();
    }
    depths.push_back(kHalf - box.getWorldTransform().getOrigin().z());
    EXPECT_NEAR(kHalf - before, depths.back(), 1e-3 * depths.back()) << weights;
  }
  EXPECT_NEAR(depths[1], 2 * depths[0], 0.05 * depths[1]);
  EXPECT_NEAR(depths[2], 4 * depths[0], 0.05 * depths[2]);
}

TEST(SubstepContacts, FrictionTurnsABoxAgainstItsWay) {
  constexpr btScalar kSpin = 10, kFriction = btScalar(0.5);
  constexpr double kSeconds = 0.2;
  SolverWorld world;
  world.addSlab().setFriction(1);
  btRigidBody& box = world.addBox(btVector3(kHalf, kHalf, kHalf / 4), 8, btVector3(0, 0, kHalf / 4));
  box.setFriction(kFriction);
  world.run(0.5);
  box.setAngularVelocity(btVector3(0, 0, kSpin));
  world.run(kSeconds, kStep / 4);  // in longer steps Bullet loses corners
  // Each corner bears as much: friction m g r / I, with r^2 = 2 h^2 and I = 2/3 m h^2.
  const double slower = kFriction * kGravity * 1.5 * std::sqrt(2.0) / kHalf * kSeconds;
  EXPECT_NEAR(box.getAngularVelocity().z(), kSpin - slower, 0.005 * slower);
}

TEST(SubstepContacts, ABlockSlidesAsFarAsFrictionLets) {
  for (const double angle : {0.0, 0.5, 0.8}) {  // friction in all directions is the same
    SolverWorld world;
    world.addFloor().setFriction(1);
    btRigidBody& block = addCube(world, 3, kHalf);
    constexpr double kFriction = 0.4, kSpeed = 3;
    block.setFriction(btScalar(kFriction));
    block.setAngularFactor(0);
    world.run(0.5);
    const btVector3 from = block.getWorldTransform().getOrigin();
    block.setLinearVelocity(
        btVector3(btScalar(kSpeed * std::cos(angle)), btScalar(kSpeed * std::sin(angle)), 0));
    world.run(2);
    const double way = kSpeed * kSpeed / (2 * kFriction * kGravity);
    EXPECT_NEAR((block.getWorldTransform().getOrigin() - from).length(), way, 0.005 * way) << angle;
    EXPECT_LT(block.getLinearVelocity().length(), 1e-5);
  }
}

// One way without friction took it from all ways.
TEST(SubstepContacts, FrictionMayBeFreeAlongOneAxis) {
  constexpr double kFriction = 0.5, kSpeed = 2, kSeconds = 0.3;
  for (const double free : {0.0, 1.0}) {
    SolverWorld world;
    world.addFloor().setFriction(1);
    btRigidBody& block = addCube(world, 3, kHalf);
    block.setFriction(btScalar(kFriction));
    block.setAnisotropicFriction(btVector3(btScalar(free), 1, 1));
    block.setAngularFactor(0);
    world.run(0.1);
    block.setLinearVelocity(btVector3(kSpeed, kSpeed, 0));
    world.run(kSeconds);
    const double lost = kFriction * kGravity * kSeconds * (free > 0 ? M_SQRT1_2 : 1);
    EXPECT_NEAR(block.getLinearVelocity().y(), kSpeed - lost, 0.005 * lost) << free;
    EXPECT_NEAR(block.getLinearVelocity().x(), free > 0 ? kSpeed - lost : kSpeed, 0.005 * lost) << free;
  }
}

TEST(SubstepContacts, BallsCollideAsMomentumAndRestitutionSay) {
  for (const double e : {0.0, 0.5, 1.0}) {
    SolverWorld world;
    world.world.setGravity(btVector3(0, 0, 0));
    btRigidBody& left = world.addBall(btScalar(0.2), 1, btVector3(btScalar(-0.71), 0, 0));
    btRigidBody& right = world.addBall(btScalar(0.2), 3, btVector3(btScalar(0.3), 0, 0));
    left.setRestitution(1);
    right.setRestitution(btScalar(e));
    left.setLinearVelocity(btVector3(2, 0, 0));
    world.run(1);
    // v1 = (m1 - e m2) / (m1 + m2) v, v2 = (1 + e) m1 / (m1 + m2) v
    EXPECT_NEAR(left.getLinearVelocity().x(), (1 - e * 3) / 4 * 2, 1e-4) << e;
    EXPECT_NEAR(right.getLinearVelocity().x(), (1 + e) / 4 * 2, 1e-4) << e;
  }
}

TEST(SubstepContacts, ARowOfBallsHandsTheSpeedToTheLastOne) {
  // They touch, and distances are exact.
  constexpr btScalar kRadius = btScalar(0.125), kSpeed = 2;
  constexpr std::size_t kBalls = 4;
  SolverWorld world;
  world.world.setGravity(btVector3(0, 0, 0));
  for (std::size_t i = 0; i < kBalls; ++i) {
    btRigidBody& ball = world.addBall(kRadius, 1, btVector3(btScalar(i) * 2 * kRadius, 0, 0));
    ball.setRestitution(1);
    ball.setFriction(0);
  }
  world.bodies[0]->setLinearVelocity(btVector3(kSpeed, 0, 0));
  world.run(0.1);
  for (std::size_t i = 0; i < kBalls; ++i)
    EXPECT_NEAR(world.bodies[i]->getLinearVelocity().x(), i + 1 == kBalls ? kSpeed : 0, 0.001 * kSpeed) << i;
}

TEST(SubstepContacts, ABoxBouncesToTheSquareOfItsRestitution) {
  SolverWorld world;
  world.addSlab().setRestitution(1);
  btRigidBody& box = addCube(world, 1, kHalf + 1);
  box.setRestitution(btScalar(0.5));
  // Bullet's boxes see each other when they touch: they are up to 4.4 m/s dt in each other then.
  constexpr double kShort = 1.0 / 240;
  world.run(0.5, kShort);
  double highest = 0;
  for (int i = 0; i < 160; ++i) {
    world.step(btScalar(kShort));
    highest = std::max(highest, double(box.getWorldTransform().getOrigin().z() - kHalf));
  }
  EXPECT_NEAR(highest, 0.25, 4.4 * kShort);
}

TEST(SubstepContacts, AGivenSpringCarriesItsLoad) {
  SolverWorld world;
  world.addSlab();
  btRigidBody& box = addCube(world, 10, kHalf);
  constexpr btScalar kStiffness = 20000;
  box.setContactStiffnessAndDamping(kStiffness, 500);
  world.run(4);
  // Four corners, each with a spring.
  const double expected = 10 * kGravity / (4 * kStiffness);
  EXPECT_NEAR(kHalf - box.getWorldTransform().getOrigin().z(), expected, 0.02 * expected);
}

TEST(SubstepContacts, RollingFrictionStopsABall) {
  SolverWorld world;
  world.addFloor().setFriction(1);
  constexpr double kRadius = 0.2, kLever = 0.01, kSpeed = 1;
  btRigidBody& ball = world.addBall(btScalar(kRadius), 1, btVector3(0, 0, btScalar(kRadius)));
  ball.setFriction(1);
  ball.setRollingFriction(btScalar(kLever));
  world.run(0.5);
  ball.setLinearVelocity(btVector3(kSpeed, 0, 0));
  ball.setAngularVelocity(btVector3(0, btScalar(kSpeed / kRadius), 0));
  const double lever =
      world.dispatcher.getManifoldByIndexInternal(0)->getContactPoint(0).m_combinedRollingFriction;
  ASSERT_GT(lever, 0);
  world.run(0.2);
  // The torque lever m g brakes m r + I / r.
  const double braking = lever * kGravity / (kRadius * (1 + 0.4));
  EXPECT_NEAR(ball.getLinearVelocity().x(), kSpeed - 0.2 * braking, 0.05 * 0.2 * braking);
  world.run(30);
  EXPECT_LT(ball.getLinearVelocity().length(), 1e-3);
}

TEST(SubstepContacts, RollingFrictionHoldsABallOnASlope) {
  // The lever is 1.25 times the radius times the tangent of the slope: the ball stays where it is.
  constexpr double kRadius = 0.2, kSlope = 0.1, kLever = 1.25 * kRadius * kSlope;
  SolverWorld world;
  world.addSlab().setFriction(1);
  world.world.setGravity(btVector3(btScalar(kSlope * kGravity), 0, -kGravity));
  btRigidBody& ball = world.addBall(btScalar(kRadius), 1, btVector3(0, 0, btScalar(kRadius)));
  ball.setFriction(1);
  ball.setRollingFriction(btScalar(kLever));
  world.run(1);
  const btVector3 before = ball.getWorldTransform().getOrigin();
  world.run(5);
  EXPECT_LT(ball.getWorldTransform().getOrigin().distance(before), 1e-5);
}

TEST(SubstepContacts, ImpulsesInPointsCarryTheWeight) {
  SolverWorld world;
  world.addFloor();
  addCube(world, 7, kHalf);
  world.run(1);
  double sum = 0;
  const btPersistentManifold& manifold = *world.dispatcher.getManifoldByIndexInternal(0);
  for (int i = 0; i < manifold.getNumContacts(); ++i) sum += manifold.getContactPoint(i).m_appliedImpulse;
  EXPECT_NEAR(sum, 7 * kGravity * kStep, 0.001 * 7 * kGravity * kStep);
}

TEST(SubstepContacts, SensorsPushNothing) {
  for (const bool split : {true, false}) {
    SolverWorld world;
    world.world.getSimulationIslandManager()->setSplitIslands(split);
    btRigidBody& sensor = world.addSlab();
    sensor.setCollisionFlags(sensor.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
    const btRigidBody& box = world.addBox(btVector3(1, 1, 1) / 2, 1, btVector3(0, 0, btScalar(0.5)));
    world.run(0.5);
    EXPECT_GT(world.dispatcher.getNumManifolds(), 0);
    EXPECT_NEAR(box.getLinearVelocity().z(), -kGravity / 2, 1e-3) << split;
  }
}

TEST(SubstepContacts, ALiftCarriesAndABeltMoves) {
  SolverWorld world;
  btRigidBody& lift = world.addBox(btVector3(1, 1, btScalar(0.1)), 0, btVector3(0, 0, btScalar(-0.1)));
  lift.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  lift.setActivationState(DISABLE_DEACTIVATION);
  const btRigidBody& load = addCube(world, 5, kHalf);
  for (int i = 0; i < 120; ++i) {
    btTransform place = lift.getWorldTransform();
    place.getOrigin() += btVector3(btScalar(0.5 * kStep), 0, btScalar(0.3 * kStep));
    lift.setWorldTransform(place);
    world.step();
  }
  const btVector3 apart = load.getWorldTransform().getOrigin() - lift.getWorldTransform().getOrigin();
  EXPECT_NEAR(apart.z(), 0.1 + kHalf, 0.001);
  EXPECT_NEAR(load.getLinearVelocity().x(), 0.5, 0.01);
  EXPECT_NEAR(load.getLinearVelocity().z(), 0.3, 0.01);

  SolverWorld belts;
  btRigidBody& belt = belts.addSlab();
  belt.setLinearVelocity(
      btVector3(0, btScalar(0.5), 0));  // a static body that does not move, but its surface does
  const btRigidBody& carried = addCube(belts, 5, kHalf);
  belts.run(2);
  EXPECT_NEAR(carried.getLinearVelocity().y(), 0.5, 0.005);
  EXPECT_NEAR(carried.getWorldTransform().getOrigin().z(), kHalf, 0.001);
}

TEST(SubstepContacts, ForcesActOverTheWholeStep) {
  SolverWorld world;
  world.world.setGravity(btVector3(0, 0, 0));
  btRigidBody& box = addCube(world, 2, 0);
  for (int i = 0; i < 60; ++i) {
    box.applyCentralForce(btVector3(6, 0, 0));
    box.applyTorque(btVector3(0, 0, btScalar(0.1)));
    world.step();
  }
  EXPECT_NEAR(box.getLinearVelocity().x(), 3, 1e-4);
  EXPECT_NEAR(box.getAngularVelocity().z(), 0.1 * box.getInvInertiaDiagLocal().z(), 1e-4);
}

TEST(SubstepContacts, FactorsAndDampingHold) {
  SolverWorld world;
  world.addFloor();
  btRigidBody& box = addCube(world, 2, kHalf);
  box.setLinearFactor(btVector3(1, 0, 1));
  box.setAngularFactor(btVector3(0, 0, 0));
  box.setLinearVelocity(btVector3(0, 1, 0));
  btRigidBody& other = world.addBall(btScalar(0.2), 1, btVector3(0, btScalar(-2), btScalar(0.2)));
  other.setLinearVelocity(btVector3(0, 5, 0));
  const btScalar y = box.getWorldTransform().getOrigin().y();
  box.setLinearVelocity(btVector3(0, 0, 0));
  world.run(2);
  EXPECT_EQ(box.getWorldTransform().getOrigin().y(), y);
  SolverWorld damped;
  damped.world.setGravity(btVector3(0, 0, 0));
  btRigidBody& slow = addCube(damped, 2, 0);
  slow.setDamping(btScalar(0.5), 0);
  slow.setLinearVelocity(btVector3(1, 0, 0));
  damped.run(2);
  EXPECT_NEAR(slow.getLinearVelocity().x(), 0.25, 0.001);  // half a second
}

// As people do who simulate in a plane. One of the rows across the normal has nothing to move then.
TEST(SubstepContacts, WhatIsHeldToAPlaneIsBraked) {
  constexpr double kRadius = 0.5, kFriction = 0.5, kSpeed = 3;
  for (const int axis : {0, 1}) {
    const auto along = [&](double x, double z) {
      return axis == 0 ? btVector3(btScalar(x), 0, btScalar(z)) : btVector3(0, btScalar(x), btScalar(z));
    };
    const auto hold = [&](btRigidBody& body) {
      body.setFriction(btScalar(kFriction));
      body.setLinearFactor(along(1, 1));
      body.setAngularFactor(axis == 0 ? btVector3(0, 1, 0) : btVector3(1, 0, 0));
    };
    SolverWorld world;
    world.addFloor().setFriction(1);
    btRigidBody& ball = world.addBall(btScalar(kRadius), 1, along(0, kRadius));
    hold(ball);
    ball.setLinearVelocity(along(kSpeed, 0));
    world.run(1);
    // It has come to roll, without a change of its angular momentum about the floor.
    EXPECT_NEAR(ball.getLinearVelocity()[axis], kSpeed / 1.4, 0.002 * kSpeed);
    EXPECT_NEAR(ball.getAngularVelocity().length(), kSpeed / 1.4 / kRadius, 0.002 * kSpeed / kRadius);

    SolverWorld slope;
    slope.addSlab().setFriction(1);
    slope.world.setGravity(along(kGravity * std::sin(0.26), -kGravity * std::cos(0.26)));
    btRigidBody& box = addCube(slope, 1, kHalf);
    hold(box);
    slope.run(2);
    EXPECT_LT(box.getWorldTransform().getOrigin().distance(along(0, kHalf)), 0.002);
  }
}

// A wall at 1 m/s pushes balls that can move up only. A wall that leans by 45 degrees lifts one as fast, and
// one that leans by what may be rounding goes through it.
TEST(SubstepContacts, WhatIsHeldAcrossAPushIsNotThrown) {
  constexpr double kStep = 1.0 / 60;
  for (const double lean : {M_PI / 4, 1e-6, 0.0}) {
    SolverWorld world;
    world.world.setGravity(btVector3(0, 0, 0));
    btRigidBody& ball = world.addBall(btScalar(0.1), 1, btVector3(0, 0, 0));
    ball.setFriction(0);
    ball.setLinearFactor(btVector3(0, 0, 1));
    ball.setAngularFactor(0);
    btRigidBody& wall = world.addBox(btVector3(btScalar(0.2), 2, 2), 0, btVector3(-1, 0, 0));
    wall.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    const btQuaternion leaning(btVector3(0, 1, 0), btScalar(-lean));
    const btScalar from = btScalar(-0.3 / std::cos(lean) - 0.1);
    double fastest = 0;
    for (int i = 0; i <= 20; ++i) {
      wall.setWorldTransform(btTransform(leaning, btVector3(from + btScalar(i * kStep), 0, 0)));
      world.step(btScalar(kStep));
      fastest = std::max(fastest, std::fabs(double(ball.getLinearVelocity().z())));
    }
    EXPECT_NEAR(fastest, lean > 0.1 ? 1 : 0, lean > 0.1 ? 0.01 : 1e-5) << lean;
  }
}

// One that leans by a thousandth would have to lift its ball 1,000 times as fast. It goes through it, too.
TEST(SubstepContacts, WhatYieldsAslantIsNotThrown) {
  constexpr double kStep = 1.0 / 60, kSpeed = 0.2;
  SolverWorld world;
  btRigidBody& ball = world.addBall(btScalar(0.1), 1, btVector3(0, 0, 0));
  ball.setFriction(0);
  ball.setLinearFactor(btVector3(0, 0, 1));
  ball.setAngularFactor(0);
  btRigidBody& wall = world.addBox(btVector3(1, 4, 4), 0, btVector3(-2, 0, 0));
  wall.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  double fastest = 0;
  for (int i = 0; i < 20; ++i) {
    wall.setWorldTransform(btTransform(btQuaternion(btVector3(0, 1, 0), btScalar(-0.001)),
                                       btVector3(btScalar(i * kSpeed * kStep - 1.1), 0, 0)));
    world.step(btScalar(kStep));
    fastest = std::max(fastest, double(ball.getLinearVelocity().z()));
  }
  EXPECT_LT(fastest, 10 * kSpeed);
}

TEST(SubstepContacts, RollingFrictionStopsWhatTurnsAboutOneAxis) {
  constexpr double kRadius = 0.5, kLever = 0.1, kSpeed = 3;
  SolverWorld world;
  world.addFloor().setFriction(1);
  btRigidBody& ball = world.addBall(btScalar(kRadius), 1, btVector3(0, 0, btScalar(kRadius)));
  ball.setFriction(1);
  ball.setRollingFriction(btScalar(kLever));
  ball.setAngularFactor(btVector3(0, 1, 0));
  ball.setLinearVelocity(btVector3(btScalar(kSpeed), 0, 0));
  ball.setAngularVelocity(btVector3(0, btScalar(kSpeed / kRadius), 0));
  world.run(1);
  // The torque lever m g brakes m r + I / r.
  const double braking = kLever * kGravity / (kRadius * 1.4);
  EXPECT_NEAR(ball.getLinearVelocity().x(), kSpeed - braking, 0.01 * braking);
}

TEST(SubstepContacts, BodiesAtRestFallAsleepAndWake) {
  SolverWorld world;
  world.addFloor();
  btRigidBody& box = addCube(world, 2, kHalf);
  box.forceActivationState(ACTIVE_TAG);
  world.run(5);
  EXPECT_EQ(box.getActivationState(), ISLAND_SLEEPING);
  EXPECT_EQ(world.solver.substeps(), 0);
  box.activate(true);
  box.applyCentralImpulse(btVector3(4, 0, 0));
  world.run(1);
  EXPECT_GT(box.getWorldTransform().getOrigin().x(), 0.1);
}

TEST(SubstepContacts, ABodyThatTumblesKeepsItsMomentumAndEnergy) {
  SolverWorld world;
  world.world.setGravity(btVector3(0, 0, 0));
  btRigidBody& plate = world.addBox(btVector3(0.5f, 0.3f, 0.1f), 1, btVector3(0, 0, 0));
  plate.setAngularVelocity(btVector3(btScalar(0.1), 5, btScalar(0.1)));
  const auto momentum = [&] {
    const btMatrix3x3& axes = plate.getWorldTransform().getBasis();
    const btVector3 spin = plate.getAngularVelocity() * axes, inverse = plate.getInvInertiaDiagLocal();
    return axes * btVector3(spin.x() / inverse.x(), spin.y() / inverse.y(), spin.z() / inverse.z());
  };
  const btVector3 before = momentum();
  const double energy = world.energy();
  world.run(20);
  EXPECT_LT((momentum() - before).length(), 1e-3 * before.length());
  EXPECT_NEAR(world.energy(), energy, 0.01 * energy);
}

constexpr btScalar kTime = btScalar(1) / 60;

/// One step in one substep: a body moves on after the row of this point on a wall was made, which a pass is
/// to stop.
BodyState afterAPass(btRigidBody& body, btRigidBody& wall, const btManifoldPoint& point) {
  body.setFlags(0);
  btPersistentManifold manifold(&body, &wall, 0, 1, 1);
  manifold.m_index1a = 0;
  manifold.addManifoldPoint(point);
  btPersistentManifold* manifolds[] = {&manifold};
  btCollisionObject* objects[] = {&body, &wall};
  btContactSolverInfo info;
  info.m_timeStep = kTime;
  SolverBodies bodies;
  bodies.begin(2, kTime);
  bodies.find(0, 2, objects);
  bodies.collect();
  bodies.fill(0, 1);
  ContactRows contacts;
  contacts.begin(1);
  contacts.find(0, 1, manifolds, bodies);
  contacts.collect(bodies);
  contacts.beginStep(info, 1, SubstepOptions().depth);
  const int pair = 0;
  contacts.clearBlocks();
  contacts.addBlock(&pair, 1);
  contacts.prepare(0, bodies);
  bodies.move(0, 1, kTime);
  contacts.solve(0, Pass::relax, bodies.states());
  body.setCompanionId(-1);
  return bodies.state(0);
}

btRigidBody& addBody(SolverWorld& world, const btVector3& half) {
  btRigidBody& body = world.addBox(half, btScalar(0.1), btVector3(0, 0, 0));
  body.setLinearVelocity(btVector3(-1, 0, 0));
  return body;
}

btManifoldPoint touching(const btVector3& place, const btVector3& normal) {
  btManifoldPoint point(place, btVector3(0, 0, 0), normal, 0);
  point.m_positionWorldOnA = point.m_positionWorldOnB = place;
  return point;
}

void stopATurnedRod(btScalar angle) {
  SolverWorld world;
  btRigidBody& rod = addBody(world, btVector3(0.5f, 0.025f, 0.025f));
  btRigidBody& wall = world.addBox(btVector3(1, 1, 1), 0, btVector3(-2, 0, 0));
  const btVector3 arm(0.4f, 0.05f, 0), normal(1, 0, 0), spin(0, angle / kTime, 0);
  rod.setAngularVelocity(spin);
  const BodyState state = afterAPass(rod, wall, touching(arm, normal));
  // Points of what is flat stay where they are, as seen from the body.
  const btScalar before = (rod.getLinearVelocity() + spin.cross(arm)).dot(normal);
  EXPECT_NEAR((state.velocity + state.spin.cross(arm)).dot(normal) / before, 0, 1e-4) << angle;
}

TEST(SubstepContacts, RowsOfARodFollowAsItTurns) {
  for (const btScalar angle : {0.1f, 0.5f, 1.0f, 1.5f, 3.0f}) stopATurnedRod(angle);
}

/// The round edge of a plate slides in a hollow that nearly fits it: the place goes further than it slides,
/// to where a push is no longer along the plate, which yields more. What a contact without friction stops
/// gains nothing.
TEST(SubstepContacts, RowsOfAPlateFollowThePlace) {
  constexpr btScalar kEdge = 10, kHollow = btScalar(-8.9);  // curvatures [1/m]
  for (const btScalar slide : {0.005f, 0.01f, 0.02f, 0.03f, 0.05f}) {
    SolverWorld world;
    btRigidBody& plate = addBody(world, btVector3(0.5f, 0.025f, 0.5f));
    btRigidBody& wall = world.addBox(btVector3(1, 1, 1), 0, btVector3(-2, 0, 0));
    plate.setLinearVelocity(btVector3(-1, slide / kTime, 0));
    const btVector3 normal(1, 0, 0);
    btManifoldPoint point = touching(btVector3(-0.5f, 0, 0), normal);
    const Across axes(-normal);
    PointBends bends;
    for (const auto& [bend, curvature] : {std::pair(&bends.a, kEdge), std::pair(&bends.b, kHollow)})
      *bend = Bend::about(btVector3(0, 0, 1), axes, curvature);
    setBends(point, bends);
    const auto energyOf = [&](const btVector3& velocity, const btVector3& spin) {
      return (velocity.length2() / plate.getInvMass() +
              (spin * spin / plate.getInvInertiaDiagLocal()).dot(btVector3(1, 1, 1))) /
             2;
    };
    const btScalar before = energyOf(plate.getLinearVelocity(), btVector3(0, 0, 0));
    const BodyState state = afterAPass(plate, wall, point);
    EXPECT_LT(energyOf(state.velocity, state.spin), before) << slide;
  }
}

TEST(SubstepContacts, RodsThatWhirlIntoEachOtherGainNothing) {
  const btVector3 half(0.025f, 0.025f, 0.5f);
  for (unsigned seed = 0; seed < 40; ++seed) {
    std::mt19937 engine(seed);
    const auto any = [&] { return btScalar(engine() % 2001) / 1000 - 1; };
    SolverWorld world;
    world.world.setGravity(btVector3(0, 0, 0));
    btVector3 momentum(0, 0, 0);
    for (int i = 0; i < 8; ++i) {
      const btVector3 at(any() / 10, btScalar(0.12) * btScalar(i), any() / 4);
      btRigidBody& rod = world.addBox(half, btScalar(0.1), at);
      const btQuaternion turn(any(), any(), any(), any());
      rod.setCenterOfMassTransform(btTransform(turn.normalized(), at));
      rod.setLinearVelocity(btVector3(any(), any() - btScalar(i), any()));
      rod.setAngularVelocity(btVector3(any(), any(), any()) * 30);
      momentum += rod.getLinearVelocity();
    }
    const auto energy = [&] {
      double places = 0;  // no gravity
      for (const auto& rod : world.bodies)
        places += double(rod->getMass() * kGravity * rod->getWorldTransform().getOrigin().z());
      return world.energy() - places;
    };
    const double start = energy();
    for (int i = 0; i < 40; ++i) {
      world.step();
      ASSERT_LT(energy(), 1.02 * start) << seed << ", step " << i;
    }
    EXPECT_LT(energy(), 0.9 * start) << seed;
    for (const auto& rod : world.bodies) momentum -= rod->getLinearVelocity();
    EXPECT_LT(momentum.length(), 1e-3) << seed;
  }
}

// All corners of a packing arrive in one substep. What one of them bears turns the body until the others
// bear, and drags it along.
TEST(SubstepContacts, AFaceThatLandsFlatStaysWhereItLands) {
  for (const double rate : {60, 240}) {
    SubstepSolver solver;
    TestWorld world;
    PackingCollisionAlgorithm::prepareWorld(world.world);
    world.world.setConstraintSolver(&solver);
    world.addFloor();
    const btRigidBody& box = world.add(makeShape(latticeBox({1, 1, 1}, 4)), 1, btVector3(0, 0, 1));
    world.run(2, 1 / rate);
    const btVector3& place = box.getWorldTransform().getOrigin();
    EXPECT_LT(std::hypot(place.x(), place.y()), 0.002) << rate;
  }
}

}  // namespace
}  // namespace innersphere::test
