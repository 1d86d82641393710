// What Bullet tells a user of contacts, and what it keeps of them.
#include <gtest/gtest.h>

#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

struct Counts {
  int started = 0, ended = 0, processed = 0, destroyed = 0, added = 0;
} counts;

/// Bullet's callbacks are global.
class Callbacks : public testing::Test {
 protected:
  Callbacks() {
    counts = {};
    gContactStartedCallback = [](btPersistentManifold* const&) { ++counts.started; };
    gContactEndedCallback = [](btPersistentManifold* const&) { ++counts.ended; };
    gContactProcessedCallback = [](btManifoldPoint&, void*, void*) { return ++counts.processed > 0; };
    gContactDestroyedCallback = [](void*) { return ++counts.destroyed > 0; };
    gContactAddedCallback = [](btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                               const btCollisionObjectWrapper*, int, int) {
      ++counts.added;
      point.m_userPersistentData = &counts;
      return true;
    };
  }
  ~Callbacks() override {
    gContactStartedCallback = nullptr;
    gContactEndedCallback = nullptr;
    gContactProcessedCallback = nullptr;
    gContactDestroyedCallback = nullptr;
    gContactAddedCallback = nullptr;
  }
  btRigidBody& drop(bool on_packing) {
    if (on_packing) {
      world.add(makeShape(latticeBox({3, 3, 2}, 12)), 0, btVector3(0, 0, -1));
    } else {
      world.addFloor();
    }
    btRigidBody& body = world.add(makeShape(latticeBox({1, 1, 1}, 6)), 1, btVector3(0, 0, btScalar(0.5)));
    body.setActivationState(DISABLE_DEACTIVATION);
    body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
    return body;
  }
  TestWorld world;
};

class CallbacksOn : public Callbacks, public testing::WithParamInterface<bool> {};

TEST_P(CallbacksOn, TellOfAContactOnceWhenItStartsAndOnceWhenItEnds) {
  btRigidBody& body = drop(GetParam());
  world.run(1);
  EXPECT_EQ(counts.started, 1);
  EXPECT_EQ(counts.ended, 0);
  EXPECT_GT(counts.added, 0);
  EXPECT_GT(counts.processed, 60);
  body.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, 5)));
  world.run(1.0 / 60);
  EXPECT_EQ(counts.started, 1);
  EXPECT_EQ(counts.ended, 1);
  EXPECT_GE(counts.destroyed, 4);  // of each point that a callback has given data
}

TEST_P(CallbacksOn, PointsAreFewAndKeepTheirImpulses) {
  drop(GetParam());
  world.run(1);
  for (int step = 0; step < 10; ++step) {
    world.run(1.0 / 60);
    double sum = 0;
    ASSERT_EQ(world.dispatcher.getNumManifolds(), 1);
    const btPersistentManifold& manifold = *world.dispatcher.getManifoldByIndexInternal(0);
    ASSERT_EQ(manifold.getNumContacts(), 4);
    for (int i = 0; i < 4; ++i) {
      const btManifoldPoint& point = manifold.getContactPoint(i);
      EXPECT_GT(point.getLifeTime(), 20);  // warm starting: the same points as half a second ago
      sum += point.getAppliedImpulse();
    }
    EXPECT_NEAR(sum, 9.81 / 60, 0.01);
  }
}

TEST_P(CallbacksOn, PointsThatWereNotFoundAgainAreRemoved) {
  btRigidBody& body = drop(GetParam());
  world.run(0.2);
  EXPECT_EQ(world.contactCount(), 4);
  body.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, btScalar(0.53))));
  body.setLinearVelocity(btVector3(0, 0, 0));
  world.world.performDiscreteCollisionDetection();
  EXPECT_EQ(world.contactCount(), 0);
}

INSTANTIATE_TEST_SUITE_P(Grounds, CallbacksOn, testing::Bool(),
                         [](const auto& info) { return info.param ? "packing" : "plane"; });

TEST_F(Callbacks, ManifoldsNameTheirBodiesInTheOrderOfTheirNormals) {
  drop(true);
  world.run(0.2);
  for (int i = 0; i < world.dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *world.dispatcher.getManifoldByIndexInternal(i);
    const double up = manifold.getBody1()->isStaticObject() ? 1 : -1;  // normals point to the first body
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
      EXPECT_NEAR(manifold.getContactPoint(k).m_normalWorldOnB.z(), up, 1e-3);
    }
  }
}

}  // namespace
}  // namespace innersphere::test
