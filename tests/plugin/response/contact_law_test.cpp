// How hard contacts push.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "response/contact_law.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

double restDepth(TestWorld& world, btRigidBody& cube, double seconds = 4) {
  cube.setActivationState(DISABLE_DEACTIVATION);
  world.run(seconds);
  EXPECT_LT(cube.getLinearVelocity().length(), 0.01);
  return 0.5 - cube.getWorldTransform().getOrigin().z();
}

TEST(ContactLaw, DefaultIsStiffWhateverMassAndStep) {
  for (const double mass : {0.001, 1.0, 1000.0}) {
    for (const double dt : {1.0 / 30, 1.0 / 60, 1.0 / 240}) {
      for (const Response response : {Response::compliant, Response::rigid}) {
        ContactOptions options;
        options.response = response;
        TestWorld world(options);
        world.addFloor();
        btRigidBody& cube =
            world.add(makeShape(latticeBox({1, 1, 1}, 8)), mass, btVector3(0, 0, btScalar(0.52)));
        cube.setActivationState(DISABLE_DEACTIVATION);
        world.run(2, dt);
        EXPECT_NEAR(cube.getWorldTransform().getOrigin().z(), 0.5, 0.005) << mass << " kg, " << dt << " s";
        EXPECT_LT(cube.getLinearVelocity().length(), 0.01);
      }
    }
  }
}

// A stiffness K [N/m^3] makes the force K V. A lattice of touching balls at depth d loses the volume of their
// caps: n^2 pi d^2 (3 r - d) / 3.
TEST(ContactLaw, GivenStiffnessBalancesTheWeightByVolume) {
  constexpr int kCells = 8;
  constexpr double kRadius = 0.5 / kCells;
  for (const double depth : {0.01, 0.03}) {
    const double volume = kCells * kCells * M_PI * depth * depth * (3 * kRadius - depth) / 3;
    ContactOptions options;
    options.stiffness = 9.81 / volume;  // for 1 kg
    TestWorld world(options);
    world.addFloor();
    btRigidBody& cube =
        world.add(makeShape(latticeBox({1, 1, 1}, kCells)), 1, btVector3(0, 0, btScalar(0.5)));
    EXPECT_NEAR(restDepth(world, cube), depth, 0.02 * depth);
  }
}

// Bullet's split impulse takes contacts deeper than 0.04 m out of the velocity solver, and their spring with
// them.
TEST(ContactLaw, SoftContactDeeperThanTheSplitImpulseThreshold) {
  constexpr int kCells = 4;
  constexpr double kRadius = 0.5 / kCells, kDepth = 0.1;
  const double volume = kCells * kCells * M_PI * kDepth * kDepth * (3 * kRadius - kDepth) / 3;
  ContactOptions options;
  options.stiffness = 9.81 / volume;
  TestWorld world(options);
  ASSERT_TRUE(world.world.getSolverInfo().m_splitImpulse);
  world.addFloor();
  btRigidBody& cube = world.add(makeShape(latticeBox({1, 1, 1}, kCells)), 1, btVector3(0, 0, btScalar(0.5)));
  EXPECT_NEAR(restDepth(world, cube), kDepth, 0.02 * kDepth);
}

TEST(ContactLaw, BodiesThatStartInsideEachOtherPartGently) {
  for (const double overlap : {0.05, 0.2, 0.45}) {
    TestWorld world;
    world.world.setGravity(btVector3(0, 0, 0));
    const auto shape = makeShape(latticeBox({1, 1, 1}, 8));
    btRigidBody& a = world.add(shape, 1, btVector3(0, 0, 0));
    btRigidBody& b = world.add(shape, 1, btVector3(btScalar(0.02), btScalar(0.01), btScalar(1 - overlap)));
    double fastest = 0;
    for (int i = 0; i < 90; ++i) {
      world.run(1.0 / 60);
      fastest = std::max(fastest, double(b.getLinearVelocity().length()));
    }
    EXPECT_GE(b.getWorldTransform().getOrigin().z() - a.getWorldTransform().getOrigin().z(), 0.99) << overlap;
    EXPECT_LT(fastest, 2) << overlap;
  }
}

/// Bodies that are deep in each other part no faster than half of their size in a second, or three times
/// their depth, but bear more the deeper they are: else what cannot bear its load sinks on and on.
TEST(ContactLaw, WhatIsHeldBackBearsMoreWithItsDepth) {
  ContactPatch patch;
  patch.normal = btVector3(0, 0, 1);
  patch.area = 1;
  patch.count = 1;
  const ContactLaw pair({}, 1, btScalar(1) / 60, 1);
  btScalar bears = 0;
  for (const double depth : {0.005, 0.01, 0.02, 0.05, 0.2, 1.0}) {
    patch.points[0].depth = btScalar(depth);
    const PointLaw at = pair.of({patch}, 0).at(btScalar(depth));
    EXPECT_LE(at.push, std::max(0.5, 3 * depth) + 1e-5) << depth;
    EXPECT_GT(at.bears, 1.2 * bears) << depth;
    bears = at.bears;
  }
}

/// What is deep in walls on both sides leaves by the way by which it is deeper in. The other wall does not
/// bear more for that: both would be pressed on it, and any change between them would throw it.
TEST(ContactLaw, WallsOnBothSidesDoNotPress) {
  std::vector<ContactPatch> walls(2);
  for (int i = 0; i < 2; ++i) {
    walls[std::size_t(i)].normal = btVector3(0, 0, btScalar(i == 0 ? 1 : -1));
    walls[std::size_t(i)].area = 1;
    walls[std::size_t(i)].count = 1;
    walls[std::size_t(i)].points[0].depth = btScalar(i == 0 ? 0.4 : 0.3);
  }
  const ContactLaw pair({}, 1, btScalar(1) / 60, 1);
  const ContactLaw::OfPatch out = pair.of(walls, 0), back = pair.of(walls, 1);
  EXPECT_GT(out.at(btScalar(0.4)).bears, 1.2 * out.at(btScalar(0.3)).bears);
  EXPECT_FLOAT_EQ(float(back.at(btScalar(0.3)).bears), float(back.at(btScalar(0.1)).bears));
}

/// Two walls of a groove: a body that moves along the middle at v leaves each at v sin.
TEST(ContactLaw, WallsOfAGrooveLetGo) {
  constexpr double kSlope = 0.3, kDeep = 0.01, kUnseen = 0.0015;  // of a body of 1 m
  std::vector<ContactPatch> walls(2);
  for (std::size_t i = 0; i < 2; ++i) {
    walls[i].normal =
        btVector3(btScalar(i == 0 ? std::cos(kSlope) : -std::cos(kSlope)), 0, btScalar(std::sin(kSlope)));
    walls[i].area = 1;
    walls[i].count = 1;
    walls[i].points[0].depth = btScalar(kDeep);
  }
  const auto lawOf = [&](const ContactOptions& options, const std::vector<ContactPatch>& patches,
                         double depth) {
    return ContactLaw(options, 1, btScalar(1) / 60, 1).of(patches, 0).at(btScalar(depth));
  };
  ContactOptions rigid, soft;
  rigid.response = Response::rigid;
  soft.stiffness = 1e5;
  for (const ContactOptions& options : {ContactOptions(), rigid}) {
    EXPECT_NEAR(lawOf(options, walls, kDeep).friction, std::pow(kUnseen / kDeep, 2), 1e-6);
    EXPECT_EQ(lawOf(options, walls, 0.9 * kUnseen).friction, 1);
    EXPECT_EQ(lawOf(options, {walls[0]}, kDeep).friction, 1);
  }
  EXPECT_LE(lawOf({}, walls, kDeep).push, 0.5 * std::sin(kSlope) + 1e-5);
  EXPECT_EQ(lawOf(soft, walls, kDeep).friction, 1);
}

TEST(ContactLaw, UsersOwnStiffnessIsKept) {
  TestWorld world;
  world.addFloor();
  btRigidBody& cube = world.add(makeShape(latticeBox({1, 1, 1}, 8)), 1, btVector3(0, 0, btScalar(0.5)));
  cube.setContactStiffnessAndDamping(100, 10);  // on each of four points
  EXPECT_NEAR(restDepth(world, cube), 9.81 / 400, 2e-3);
}

TEST(ContactLaw, MaterialCallbackSeesEveryPoint) {
  static int calls;
  calls = 0;
  gContactAddedCallback = [](btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                             const btCollisionObjectWrapper*, int, int) {
    ++calls;
    point.m_combinedFriction = 0;
    return true;
  };
  TestWorld world;
  world.addFloor();
  btRigidBody& cube = world.add(makeShape(latticeBox({1, 1, 1}, 8)), 1, btVector3(0, 0, btScalar(0.5)));
  cube.setCollisionFlags(cube.getCollisionFlags() | btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
  cube.setLinearVelocity(btVector3(1, 0, 0));
  world.run(1);
  gContactAddedCallback = nullptr;
  EXPECT_GE(calls, 4 * 59);
  EXPECT_NEAR(cube.getLinearVelocity().x(), 1, 0.01);  // without friction it slides on
}

TEST(ContactLaw, FrictionStopsASlidingBodyAsCoulombSays) {
  for (const bool on_packing : {false, true}) {
    TestWorld world;
    if (on_packing) {
      world.add(makeShape(latticeBox({6, 6, 2}, 12)), 0, btVector3(0, 0, -1));
    } else {
      world.addFloor();
    }
    world.bodies[0]->setFriction(1);
    btRigidBody& cube =
        world.add(makeShape(latticeBox({1, 1, btScalar(0.2)}, 10)), 1, btVector3(0, 0, btScalar(0.1)));
    cube.setFriction(btScalar(0.3));
    world.run(0.25);
    const btVector3 start = cube.getWorldTransform().getOrigin();
    cube.setLinearVelocity(btVector3(2, 0, 0));
    world.run(1.5, 1.0 / 240);
    const double distance = cube.getWorldTransform().getOrigin().x() - start.x();
    EXPECT_NEAR(distance, 4 / (2 * 0.3 * 9.81), 0.03) << (on_packing ? "packing" : "plane");
  }
}

// A user's callback that gives friction directions and a speed of its own makes a belt of the ground.
TEST(ContactLaw, ABeltCarriesWhatLiesOnIt) {
  gContactAddedCallback = [](btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                             const btCollisionObjectWrapper*, int, int) {
    point.m_contactPointFlags |= BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED;
    point.m_lateralFrictionDir1 = btVector3(1, 0, 0);
    point.m_lateralFrictionDir2 = btVector3(0, 1, 0);
    point.m_contactMotion1 = btScalar(0.5);
    return true;
  };
  TestWorld world;
  world.world.getSolverInfo().m_solverMode |=
      SOLVER_ENABLE_FRICTION_DIRECTION_CACHING | SOLVER_USE_2_FRICTION_DIRECTIONS;
  world.addFloor();
  btRigidBody& cube = world.add(makeShape(latticeBox({1, 1, 1}, 8)), 1, btVector3(0, 0, btScalar(0.5)));
  cube.setCollisionFlags(cube.getCollisionFlags() | btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
  world.run(2);
  gContactAddedCallback = nullptr;
  EXPECT_NEAR(std::abs(double(cube.getLinearVelocity().x())), 0.5, 0.01);
}

TEST(ContactLaw, RestitutionBounces) {
  TestWorld world;
  world.addFloor().setRestitution(1);
  btRigidBody& ball = world.add(makeShape(singleBall(0.5)), 1, btVector3(0, 0, btScalar(1.5)));
  ball.setRestitution(btScalar(0.8));
  double highest = 0;
  bool bounced = false;
  for (int i = 0; i < 480; ++i) {
    world.run(1.0 / 240, 1.0 / 240);
    bounced = bounced || ball.getLinearVelocity().z() > 0;
    if (bounced) highest = std::max(highest, double(ball.getWorldTransform().getOrigin().z()));
  }
  EXPECT_NEAR(highest, 0.5 + 0.64, 0.05);
}

}  // namespace
}  // namespace innersphere::test
