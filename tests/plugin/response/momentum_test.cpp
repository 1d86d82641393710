#include <gtest/gtest.h>

#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

struct Momentum {
  btVector3 linear{0, 0, 0};
  btVector3 angular{0, 0, 0};
};

Momentum momentumOf(const TestWorld& world) {
  Momentum sum;
  for (const auto& body : world.bodies) {
    const btVector3 p = body->getLinearVelocity() / body->getInvMass();
    sum.linear += p;
    sum.angular += body->getWorldTransform().getOrigin().cross(p) +
                   body->getInvInertiaTensorWorld().inverse() * body->getAngularVelocity();
  }
  return sum;
}

TEST(Momentum, IsKeptWhenTwoPackingsCollide) {
  for (const Response response : {Response::compliant, Response::rigid}) {
    ContactOptions options;
    options.response = response;
    TestWorld world(options);
    world.world.setGravity(btVector3(0, 0, 0));
    const auto shape = makeShape(latticeBox({1, 1, 1}, 6));
    btRigidBody& a =
        world.add(shape, 2, btVector3(0, 0, 0), btQuaternion(btVector3(1, 1, 0).normalized(), 1));
    btRigidBody& b = world.add(shape, 1, btVector3(2, btScalar(0.4), btScalar(0.2)));
    a.setLinearVelocity(btVector3(1, 0, 0));
    b.setLinearVelocity(btVector3(-3, 0, 0));
    b.setAngularVelocity(btVector3(0, 2, 1));
    const Momentum before = momentumOf(world);
    const btVector3 velocity_before = b.getLinearVelocity();
    world.run(1.5, 1.0 / 240);
    const Momentum after = momentumOf(world);
    EXPECT_GT((b.getLinearVelocity() - velocity_before).length(), 1) << "they did not meet";
    EXPECT_LT((after.linear - before.linear).length(), 1e-3);
    // Bullet integrates the gyroscopic force implicitly, which turns the angular momentum a little.
    EXPECT_LT((after.angular - before.angular).length(), 0.05 * before.angular.length());
  }
}

TEST(Momentum, ABlockOnABlockInFreeSpaceDoesNotCreep) {
  TestWorld world;
  world.world.setGravity(btVector3(0, 0, 0));
  const auto shape = makeShape(latticeBox({1, 1, 1}, 6));
  world.add(shape, 1, btVector3(0, 0, 0));
  world.add(shape, 1, btVector3(0, 0, 1));
  world.run(2);
  EXPECT_LT(world.kineticEnergy(), 1e-6);
}

}  // namespace
}  // namespace innersphere::test
