// What must not happen whatever the user does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include <BulletCollision/CollisionDispatch/btCollisionDispatcherMt.h>
#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <LinearMath/btThreads.h>

#include "capture_log.hpp"
#include "innersphere/pair_overlaps.hpp"
#include "innersphere/substep_solver.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

TEST(Robustness, ABodyAtNanIsSkippedAndReportedOnce) {
  CaptureLog log;
  TestWorld world;
  world.addFloor();
  const auto shape = makeShape(latticeBox({1, 1, 1}, 6));
  btRigidBody& lost = world.add(shape, 1, btVector3(0, 0, btScalar(0.5)));
  btRigidBody& other = world.add(shape, 1, btVector3(0, 0, btScalar(1.5)));
  world.run(0.1);
  btTransform broken = lost.getWorldTransform();
  broken.getOrigin().setX(std::numeric_limits<btScalar>::quiet_NaN());
  lost.setWorldTransform(broken);
  // Dispatch what the broadphase knew before, as when the body breaks in the middle of a step.
  for (int i = 0; i < 3; ++i) {
    world.dispatcher.dispatchAllCollisionPairs(world.broadphase.getOverlappingPairCache(),
                                               world.world.getDispatchInfo(), &world.dispatcher);
  }
  EXPECT_EQ(log.messages.size(), 2u);  // with the floor and with the other box
  for (int i = 0; i < world.dispatcher.getNumManifolds(); ++i) {
    EXPECT_EQ(world.dispatcher.getManifoldByIndexInternal(i)->getNumContacts(), 0);
  }
  world.world.removeRigidBody(&lost);
  world.run(3);
  EXPECT_NEAR(other.getWorldTransform().getOrigin().z(), 0.5, 0.01);
  world.world.addRigidBody(&lost);  // TestWorld removes it
}

struct SpinCase {
  std::string name;
  std::shared_ptr<btCollisionShape> ground, body;
};

std::vector<SpinCase> spinCases() {
  const auto packing = makeShape(latticeBox({1, 1, 1}, 4)), slab = makeShape(latticeBox({4, 4, 1}, 8));
  const btVector3 half(btScalar(0.5), btScalar(0.5), btScalar(0.5));
  const auto hull = std::make_shared<btConvexHullShape>();
  for (int i = 0; i < 8; ++i)
    hull->addPoint(btVector3(btScalar(i & 1), btScalar(i >> 1 & 1), btScalar(i >> 2)) - half);
  const auto ball = std::make_shared<btSphereShape>(btScalar(0.5));
  return {{"box", slab, std::make_shared<btBoxShape>(half)},
          {"cylinder", slab, std::make_shared<btCylinderShapeZ>(half)},
          {"hull", slab, hull},
          {"cone", slab, std::make_shared<btConeShapeZ>(btScalar(0.5), btScalar(1))},
          {"ball", slab, ball},
          {"packing", slab, packing},
          {"packing on a box", std::make_shared<btBoxShape>(btVector3(2, 2, half.z())), packing},
          {"packing on a ball", ball, packing},
          {"packing on a cone", std::make_shared<btConeShapeZ>(btScalar(2), btScalar(1)), packing}};
}

/// Lengths of such vectors are not finite, nor is what follows from them.
TEST(Robustness, ABodyOfInfiniteSpeedTouchesNothingAndIsNamedOnce) {
  constexpr btScalar kInfinity = std::numeric_limits<btScalar>::infinity();
  const btScalar too_large = 2 * std::sqrt(std::numeric_limits<btScalar>::max());
  for (const SpinCase& c : spinCases()) {
    for (const bool substeps : {false, true}) {
      for (const btScalar speed : {too_large, kInfinity, std::numeric_limits<btScalar>::quiet_NaN()}) {
        CaptureLog log;
        SubstepSolver divided;
        TestWorld world;
        if (substeps) world.world.setConstraintSolver(&divided);
        PackingCollisionAlgorithm::prepareWorld(world.world);
        world.add(c.ground, 0, btVector3(0, 0, btScalar(-0.5)));
        btRigidBody& body = world.add(c.body, 1, btVector3(0, 0, btScalar(0.49)));
        body.setUserIndex(7);
        body.setCcdMotionThreshold(btScalar(speed == too_large ? 0.1 : 0));
        world.run(1.0 / 60);
        EXPECT_GT(world.contactCount(), 0) << c.name;
        body.setAngularVelocity(btVector3(0, speed, 0));
        world.run(1.0 / 60);
        EXPECT_EQ(world.contactCount(), 0) << c.name << ' ' << speed;
        world.run(0.2);
        const auto named = std::count_if(log.messages.begin(), log.messages.end(), [](const auto& message) {
          return message.find("getUserIndex() 7 ") != std::string::npos &&
                 message.find("contacts are skipped") != std::string::npos;
        });
        EXPECT_EQ(named, 1) << c.name << ' ' << speed;
      }
    }
  }
}

/// Its squares are finite still, so it has contacts; what is made of them must be finite, too.
TEST(Robustness, PointsOfABodyOfAnEnormousSpeedAreFinite) {
  const btScalar enormous = std::sqrt(std::numeric_limits<btScalar>::max()) / 4;
  for (const SpinCase& c : spinCases()) {
    for (const bool turns : {false, true}) {
      TestWorld world;
      world.add(c.ground, 0, btVector3(0, 0, btScalar(-0.5)));
      btRigidBody& body = world.add(c.body, 1, btVector3(0, 0, btScalar(0.49)));
      world.run(1.0 / 60);
      if (turns) {
        body.setAngularVelocity(btVector3(0, enormous, 0));
      } else {
        body.setLinearVelocity(btVector3(0, 0, -enormous));
      }
      world.dispatcher.dispatchAllCollisionPairs(world.broadphase.getOverlappingPairCache(),
                                                 world.world.getDispatchInfo(), &world.dispatcher);
      EXPECT_GT(world.contactCount(), 0) << c.name;
      for (const btManifoldPoint& point : world.contactsOfLast()) {
        EXPECT_TRUE(std::isfinite(point.getDistance())) << c.name;
        EXPECT_TRUE(std::isfinite(point.getPositionWorldOnA().length2())) << c.name;
      }
    }
  }
}

/// A user has to find it among a thousand.
TEST(Robustness, BodiesOfAPairWithBadInputAreNamed) {
  CaptureLog log;
  TestWorld world;
  const auto shape = makeShape(latticeBox({1, 1, 1}, 4));
  world.add(shape, 0, btVector3(0, 0, 0));
  btRigidBody& stretched = world.add(shape, 1, btVector3(0, 0, btScalar(0.9)));
  stretched.setUserIndex(7);
  btTransform place = stretched.getWorldTransform();
  place.setBasis(place.getBasis().scaled(btVector3(2, 1, 1)));
  stretched.setWorldTransform(place);
  world.run(0.1);
  ASSERT_EQ(log.messages.size(), 1u);
  for (const char* part : {"A, the body with getWorldArrayIndex() 0 and getUserIndex() -1",
                           "B, the one with getWorldArrayIndex() 1 and getUserIndex() 7",
                           "the rotation of B is off orthonormal", "setWorldTransform()"})
    EXPECT_NE(log.messages[0].find(part), std::string::npos) << log.messages[0];
}

TEST(Robustness, ChangedShapeOfALivingPair) {
  TestWorld world;
  world.addFloor();
  btRigidBody& body = world.add(makeShape(latticeBox({1, 1, 1}, 6)), 1, btVector3(0, 0, btScalar(0.5)));
  world.run(0.2);
  const auto half = makeShape(latticeBox({btScalar(0.5), btScalar(0.5), btScalar(0.5)}, 6));
  body.setCollisionShape(half.get());
  body.activate();
  world.run(2);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.25, 0.005);
  btSphereShape sphere(btScalar(0.3));
  body.setCollisionShape(&sphere);
  world.run(0.1);  // the pair has no packing any more; nothing may crash
  world.world.removeRigidBody(&body);
  world.world.addRigidBody(&body);
  body.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, 1)));
  body.activate();
  world.run(2);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.3, 0.02);
}

std::shared_ptr<const CollisionModel> cubeModel(double height) {
  return std::make_shared<CollisionModel>(std::make_shared<Packing>(latticeBox({1, 1, height}, 6)));
}

/// Memory in which shapes are made, and which holds nothing that could be read once they are gone.
class ShapePlace {
 public:
  ~ShapePlace() { free(); }
  template <class Shape, class... Arguments>
  Shape* make(Arguments&&... arguments) {
    free();
    auto* const made = new (memory_) Shape(std::forward<Arguments>(arguments)...);
    shape_ = made;
    return made;
  }
  void free() {
    if (shape_ != nullptr) shape_->~btCollisionShape();
    shape_ = nullptr;
    std::memset(memory_, 0xdd, sizeof memory_);
  }

 private:
  alignas(16) unsigned char memory_[std::max(sizeof(PackingShape), sizeof(btBoxShape))];
  btCollisionShape* shape_ = nullptr;
};

/// Of this height as a packing, of 1 m as a box.
btCollisionShape* makeCube(ShapePlace& place, bool packing, double height) {
  if (packing) return place.make<PackingShape>(cubeModel(height));
  return place.make<btBoxShape>(btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5)));
}

// Bullet says nothing to a dispatcher when a body gets another shape, or a compound loses a child.
TEST(Robustness, ShapesThatAreFreedWhenBodiesHaveOthersAreNotRead) {
  const auto cube = std::make_shared<PackingShape>(cubeModel(1));
  const btVector3 half(btScalar(0.5), btScalar(0.5), btScalar(0.5));
  for (const bool on_packing : {true, false}) {
    for (const bool was_packing : {true, false}) {
      for (const bool in_place : {true, false}) {
        ShapePlace place, other_place;
        TestWorld world;
        world.addFloor();
        if (on_packing)
          world.add(cube, 0, half * btVector3(0, 0, 1));
        else
          world.add(std::make_shared<btBoxShape>(half), 0, half * btVector3(0, 0, 1));
        btRigidBody& body = world.add(cube, 1, btVector3(0, 0, btScalar(1.5)));
        body.setCollisionShape(makeCube(place, was_packing, 1));
        world.run(0.2);
        // Of another kind at the same address, or of the same kind at another one. Bullet takes no packing
        // where a convex shape was.
        if (in_place && !was_packing) continue;
        const bool packing = was_packing && !in_place;
        body.setCollisionShape(makeCube(in_place ? place : other_place, packing, 0.8));
        if (!in_place) place.free();
        body.activate();
        pairOverlaps(&world.dispatcher);
        world.run(2);
        EXPECT_TRUE(std::isfinite(body.getWorldTransform().getOrigin().z()));
        // Pairs of a body that has lost its packing are asked for anew when it is added again.
        world.world.removeRigidBody(&body);
        world.world.addRigidBody(&body);
        body.setCenterOfMassTransform(
            btTransform(btQuaternion::getIdentity(), btVector3(0, 0, btScalar(1.5))));
        body.setLinearVelocity(btVector3(0, 0, 0));
        body.setAngularVelocity(btVector3(0, 0, 0));
        body.activate();
        world.run(2);
        EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), packing ? 1.4 : 1.5, 0.02)
            << on_packing << was_packing << in_place;
        world.world.removeRigidBody(&body);
      }
    }
  }
}

TEST(Robustness, ChildrenThatAreFreedWhenTheirCompoundLosesThemAreNotRead) {
  const auto cube = makeShape(latticeBox({1, 1, 1}, 6));
  for (const bool packing : {true, false}) {
    ShapePlace first, second;
    const auto compound = std::make_shared<btCompoundShape>();
    for (ShapePlace* place : {&first, &second})
      compound->addChildShape(
          btTransform(btQuaternion::getIdentity(), btVector3(0, btScalar(place == &first ? -1 : 0), 0)),
          makeCube(*place, packing, 1));
    TestWorld world;
    world.add(makeShape(latticeBox({6, 6, 1}, 8)), 0, btVector3(0, 0, btScalar(-0.5)));
    // A pair that Bullet asks for first begins the update of all.
    world.add(cube, 1, btVector3(2, 0, btScalar(0.5)));
    btRigidBody& body = world.add(compound, 1, btVector3(0, 0, btScalar(0.5)));
    world.run(0.2);
    compound->removeChildShape(compound->getChildShape(0));
    first.free();
    body.activate();
    world.run(1);
    EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.5, 0.01) << packing;
    world.world.removeRigidBody(&body);
    compound->removeChildShape(compound->getChildShape(0));
  }
}

TEST(Robustness, RemovedBodiesLeaveNothingBehind) {
  TestWorld world;
  const auto shape = makeShape(latticeBox({1, 1, 1}, 6));
  world.add(shape, 0, btVector3(0, 0, 0));
  for (int i = 0; i < 3; ++i) world.add(shape, 1, btVector3(0, 0, btScalar(1.0 + i)));
  world.run(0.2);
  EXPECT_GT(world.dispatcher.getNumManifolds(), 0);
  while (world.bodies.size() > 1) {
    world.world.removeRigidBody(world.bodies.back().get());
    world.bodies.pop_back();
    world.run(0.05);
  }
  EXPECT_EQ(world.dispatcher.getNumManifolds(), 0);
}

TEST(Robustness, KinematicBodiesCarryOthers) {
  TestWorld world;
  const auto shape = makeShape(latticeBox({2, 2, 1}, 8));
  btRigidBody& lift = world.add(shape, 0, btVector3(0, 0, 0));
  lift.setCollisionFlags(lift.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  lift.setActivationState(DISABLE_DEACTIVATION);
  btRigidBody& cube = world.add(makeShape(latticeBox({1, 1, 1}, 6)), 1, btVector3(0, 0, btScalar(1.0)));
  for (int i = 0; i < 120; ++i) {
    lift.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, btScalar(0.005 * i))));
    world.run(1.0 / 60);
  }
  EXPECT_NEAR(cube.getWorldTransform().getOrigin().z(), 0.005 * 119 + 1, 0.01);
}

TEST(Robustness, SensorsReportButDoNotPush) {
  TestWorld world;
  btRigidBody& sensor = world.add(makeShape(latticeBox({1, 1, 1}, 6)), 0, btVector3(0, 0, 0));
  sensor.setCollisionFlags(sensor.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
  btRigidBody& cube = world.add(makeShape(latticeBox({1, 1, 1}, 6)), 1, btVector3(0, 0, btScalar(0.9)));
  world.run(0.1);
  EXPECT_GT(world.contactCount(), 0);
  world.run(1);
  EXPECT_LT(cube.getWorldTransform().getOrigin().z(), -2);
}

TEST(Robustness, GhostObjectsSeeOverlaps) {
  btGhostPairCallback callback;
  btPairCachingGhostObject ghost;
  TestWorld world;
  const auto shape = makeShape(latticeBox({1, 1, 1}, 6));
  ghost.setCollisionShape(shape.get());
  ghost.setCollisionFlags(ghost.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
  world.broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(&callback);
  world.world.addCollisionObject(&ghost);
  world.add(shape, 1, btVector3(0, 0, btScalar(0.5)));
  world.run(1.0 / 60);
  EXPECT_EQ(ghost.getNumOverlappingObjects(), 1);
  EXPECT_GT(world.contactCount(), 0);
  world.world.removeCollisionObject(&ghost);
}

TEST(Robustness, SleepingBodiesSleepAndWake) {
  TestWorld world;
  world.addFloor();
  const auto shape = makeShape(latticeBox({1, 1, 1}, 6));
  btRigidBody& lower = world.add(shape, 1, btVector3(0, 0, btScalar(0.5)));
  world.add(shape, 1, btVector3(0, 0, btScalar(1.5)));
  world.run(3);
  EXPECT_FALSE(lower.isActive());
  btRigidBody& hammer = world.add(shape, 1, btVector3(0, 0, btScalar(2.8)));
  world.run(3);
  EXPECT_NEAR(hammer.getWorldTransform().getOrigin().z(), 2.5, 0.01);
}

TEST(Robustness, MultithreadedDispatcher) {
  btSetTaskScheduler(btGetSequentialTaskScheduler());
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcherMt dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity(btVector3(0, 0, -10));
  PackingCollisionAlgorithm::registerAlgorithm(&dispatcher);
  const auto shape = makeShape(latticeBox({1, 1, 1}, 6));
  btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  btRigidBody floor(0, nullptr, &plane);
  world.addRigidBody(&floor);
  btVector3 inertia;
  shape->calculateLocalInertia(1, inertia);
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  for (int i = 0; i < 3; ++i) {
    bodies.push_back(std::make_unique<btRigidBody>(1, nullptr, shape.get(), inertia));
    bodies.back()->setWorldTransform(
        btTransform(btQuaternion::getIdentity(), btVector3(0, 0, btScalar(0.55 + 1.05 * i))));
    world.addRigidBody(bodies.back().get());
  }
  for (int i = 0; i < 180; ++i) world.stepSimulation(btScalar(1) / 60, 0);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(bodies[i]->getWorldTransform().getOrigin().z(), 0.5 + i, 0.01);
  for (const auto& body : bodies) world.removeRigidBody(body.get());
  world.removeRigidBody(&floor);
}

TEST(Robustness, SameStepsSameBits) {
  const auto positions = [] {
    TestWorld world;
    world.addFloor();
    const auto shape = makeShape(latticeBox({1, 1, 1}, 6));
    for (int i = 0; i < 4; ++i) {
      world.add(shape, 1, btVector3(btScalar(0.1 * i), btScalar(0.03 * i), btScalar(0.6 + 1.1 * i)),
                btQuaternion(btVector3(0, 0, 1), btScalar(0.2 * i)));
    }
    world.run(2);
    std::vector<btVector3> result;
    for (const auto& body : world.bodies) result.push_back(body->getWorldTransform().getOrigin());
    return result;
  };
  EXPECT_EQ(positions(), positions());
}

}  // namespace
}  // namespace innersphere::test
