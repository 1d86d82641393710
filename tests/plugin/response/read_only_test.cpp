// Contacts that are only read, as no solver does anything about them, have their true depth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <tuple>

#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <BulletDynamics/Character/btKinematicCharacterController.h>

#include "innersphere/substep_solver.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kStep = 1.0 / 60;
const double kDepths[] = {0.05, 0.3, 0.6};

std::shared_ptr<btCollisionShape> cube() {
  static const std::shared_ptr<btCollisionShape> shape = makeShape(latticeBox({1, 1, 1}, 8));
  return shape;
}

/// 2 m high and wide.
std::shared_ptr<btCollisionShape> block(bool packed) {
  static const std::shared_ptr<btCollisionShape> packing = makeShape(latticeBox({2, 2, 2}, 8));
  if (packed) return packing;
  return std::make_shared<btBoxShape>(btVector3(1, 1, 1));
}

/// Of the unit cube so deep in a block whose top is at z = 0.
btTransform placeAt(double depth) {
  return btTransform(btQuaternion::getIdentity(), btVector3(0, 0, btScalar(0.5 - depth)));
}

double deepest(btCollisionDispatcher& dispatcher) {
  double depth = 0;
  for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(m);
    for (int i = 0; i < manifold.getNumContacts(); ++i) {
      const btManifoldPoint& point = manifold.getContactPoint(i);
      depth = std::max(depth, -double(point.getDistance()));
      const btVector3 way = point.getPositionWorldOnA() - point.getPositionWorldOnB();
      EXPECT_NEAR(way.dot(point.m_normalWorldOnB), point.getDistance(), 1e-4);
    }
  }
  return depth;
}

/// Who is in the block, and in which world.
class ReadOnly : public testing::TestWithParam<std::tuple<std::string, Response, bool>> {};

TEST_P(ReadOnly, DepthIsThatOfTheBodies) {
  const auto& [who, response, packed] = GetParam();
  ContactOptions options;
  options.response = response;
  for (const double depth : kDepths) {
    TestWorld world(options, who == "batched_sensor" ? DispatcherKind::batched : DispatcherKind::plain);
    world.world.setGravity(btVector3(0, 0, 0));
    btRigidBody& ground = world.add(block(packed), 0, btVector3(0, 0, -1));
    const std::shared_ptr<btCollisionShape> shape = cube();
    btPairCachingGhostObject ghost;
    if (who == "ghost") {
      ghost.setCollisionShape(shape.get());
      ghost.setCollisionFlags(btCollisionObject::CF_CHARACTER_OBJECT);
      ghost.setWorldTransform(placeAt(depth));
      world.world.addCollisionObject(&ghost, btBroadphaseProxy::CharacterFilter,
                                     btBroadphaseProxy::AllFilter);
    } else if (who == "kinematic") {
      btRigidBody& body = world.add(shape, 0, placeAt(depth).getOrigin());
      world.world.removeRigidBody(&body);
      body.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
      body.setActivationState(DISABLE_DEACTIVATION);
      world.world.addRigidBody(&body, btBroadphaseProxy::KinematicFilter, btBroadphaseProxy::AllFilter);
    } else if (who == "on_sensor") {
      ground.setCollisionFlags(ground.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
      world.add(shape, 1, placeAt(depth).getOrigin());
    } else {
      btRigidBody& body = world.add(shape, 1, placeAt(depth).getOrigin());
      body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
    }
    for (int i = 0; i < 3; ++i) {
      world.run(kStep, kStep);
      EXPECT_NEAR(deepest(world.dispatcher), depth, 2e-3) << depth << ", step " << i;
    }
    if (who == "ghost") world.world.removeCollisionObject(&ghost);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, ReadOnly,
    testing::Combine(testing::Values("sensor", "batched_sensor", "on_sensor", "kinematic", "ghost"),
                     testing::Values(Response::compliant, Response::rigid), testing::Bool()),
    [](const auto& info) {
      return std::get<0>(info.param) + nameOf(std::get<1>(info.param)) +
             (std::get<2>(info.param) ? "InPacking" : "InBox");
    });

// What pushes itself out by the depth, as characters do, is out after one push.
TEST(ReadOnlyWorld, OnePushByTheDepthTakesACubeOutOfAnother) {
  for (const Response response : {Response::compliant, Response::rigid}) {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btCollisionWorld world(&dispatcher, &broadphase, &configuration);
    ContactOptions options;
    options.response = response;
    PackingCollisionAlgorithm::registerAlgorithm(&dispatcher, options);
    const std::shared_ptr<btCollisionShape> shape = cube();
    btCollisionObject lower, upper;
    lower.setCollisionShape(shape.get());
    upper.setCollisionShape(shape.get());
    upper.setWorldTransform(
        btTransform(btQuaternion::getIdentity(), btVector3(btScalar(0.1), btScalar(0.05), btScalar(0.6))));
    world.addCollisionObject(&lower);
    world.addCollisionObject(&upper);
    world.performDiscreteCollisionDetection();
    EXPECT_NEAR(deepest(dispatcher), 0.4, 2e-3);
    world.removeCollisionObject(&upper);
    world.removeCollisionObject(&lower);
    PackingCollisionAlgorithm::unregisterAlgorithm(&dispatcher);
  }
}

// 0.25 m in a wall whose face is at x = 1. Bullet pushes it out while it is deeper than it is let be.
TEST(ReadOnlyWorld, ACharacterLeavesAWallAsItDoesBulletsBox) {
  constexpr double kRadius = 0.3;
  const auto depthAfter = [](bool packed, bool substeps, double allowed) {
    SubstepSolver divided;
    TestWorld world;
    if (substeps) world.world.setConstraintSolver(&divided);
    PackingCollisionAlgorithm::registerAlgorithm(world.world);
    btGhostPairCallback callback;
    world.broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(&callback);
    world.addFloor();
    world.add(block(packed), 0, btVector3(2, 0, 1));
    btPairCachingGhostObject ghost;
    btCapsuleShapeZ capsule(kRadius, 1);
    ghost.setCollisionShape(&capsule);
    ghost.setCollisionFlags(btCollisionObject::CF_CHARACTER_OBJECT);
    ghost.setWorldTransform(
        btTransform(btQuaternion::getIdentity(), btVector3(btScalar(0.95), 0, btScalar(0.8))));
    btKinematicCharacterController character(&ghost, &capsule, btScalar(0.35), btVector3(0, 0, 1));
    character.setMaxPenetrationDepth(btScalar(allowed));
    world.world.addCollisionObject(&ghost, btBroadphaseProxy::CharacterFilter,
                                   btBroadphaseProxy::StaticFilter | btBroadphaseProxy::DefaultFilter);
    world.world.addAction(&character);
    world.run(3 * kStep, kStep);
    world.world.removeAction(&character);
    world.world.removeCollisionObject(&ghost);
    world.broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(nullptr);
    return ghost.getWorldTransform().getOrigin().x() + kRadius - 1;
  };
  for (const double allowed : {0.2, 0.0}) {
    for (const bool substeps : {false, true}) {
      for (const bool packed : {false, true})
        EXPECT_LT(depthAfter(packed, substeps, allowed), allowed + 0.01) << packed << ' ' << substeps;
    }
  }
}

// It was read, with its true depth, until a solver was to do something about it.
TEST(ReadOnlyWorld, ABodyThatWasASensorLeavesAsOneThatWasNone) {
  for (const bool packed : {false, true}) {
    for (const double depth : kDepths) {
      const auto motionAfter = [&](bool was_sensor) {
        TestWorld world;
        world.world.setGravity(btVector3(0, 0, 0));
        world.world.getSolverInfo().m_numIterations = 50;  // ten end 0.4 % above the law
        world.add(block(packed), 0, btVector3(0, 0, -1));
        btRigidBody& body = world.add(cube(), 1, placeAt(depth).getOrigin());
        body.setActivationState(DISABLE_DEACTIVATION);
        const int flags = body.getCollisionFlags();
        if (was_sensor) {
          body.setCollisionFlags(flags | btCollisionObject::CF_NO_CONTACT_RESPONSE);
          world.run(3 * kStep, kStep);
          EXPECT_EQ(body.getLinearVelocity(), btVector3(0, 0, 0));
          body.setCollisionFlags(flags);
        }
        world.run(5 * kStep, kStep);
        // Half the size of the cube, or three times the depth, in a second.
        EXPECT_LT(body.getLinearVelocity().length(), std::max(std::sqrt(3.0) / 4, 3 * depth) + 0.001);
        return world.motion();
      };
      EXPECT_EQ(motionAfter(true), motionAfter(false)) << depth << (packed ? " in packing" : " in box");
    }
  }
}

}  // namespace
}  // namespace innersphere::test
