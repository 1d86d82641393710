// Worlds that are not as they should be.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "capture_log.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

struct Deepest : btCollisionWorld::ContactResultCallback {
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    depth = std::fmax(depth, -double(point.getDistance()));
    finite = finite && std::isfinite(point.getPositionWorldOnA().length2());
    return 0;
  }
  double depth = -1e9;
  bool finite = true;
};

/// Two cubes far from the origin, 0.1 deep in each other. Where they are is only as exact as Bullet's
/// scalars, but the contact between them is found from the difference.
class FarAway : public testing::TestWithParam<double> {};

TEST_P(FarAway, DepthIsExact) {
  TestWorld world;
  const btScalar x = btScalar(GetParam());
  const auto shape = makeShape(latticeBox({1, 1, 1}, 6));
  btRigidBody& lower = world.add(shape, 0, btVector3(x, 0, 0));
  btRigidBody& upper = world.add(shape, 1, btVector3(x, 0, btScalar(0.9)));
  Deepest found;
  world.world.contactPairTest(&lower, &upper, found);
  EXPECT_TRUE(found.finite);
  EXPECT_NEAR(found.depth, 0.1, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Distances, FarAway, testing::Values(1e3, 1e6, 1e9, 1e12), [](const auto& info) {
  return std::string("e").append(std::to_string(std::lround(std::log10(info.param))));
});

TEST(FarAwayWorld, BodiesRestAThousandKilometresOut) {
  const double x = sizeof(btScalar) == 8 ? 1e6 : 1e3;  // in single precision 1e6 m is exact to 6 cm
  TestWorld world;
  world.add(makeShape(latticeBox({3, 3, 2}, 12)), 0, btVector3(btScalar(x), 0, -1));
  btRigidBody& body =
      world.add(makeShape(latticeBox({1, 1, 1}, 6)), 1, btVector3(btScalar(x), 0, btScalar(0.52)));
  world.run(2);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.5, 0.005);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().x(), x, 0.005);
}

/// In single precision steps of a body are rounded there, in Bullet itself: what is left is that nothing
/// breaks.
TEST(FarAwayWorld, NothingBreaksWhereScalarsAreCoarse) {
  for (const double x : {1e6, 1e7, 1e15, 1e18}) {
    TestWorld world;
    world.add(makeShape(latticeBox({3, 3, 2}, 6)), 0, btVector3(btScalar(x), 0, -1));
    world.add(makeShape(latticeBox({1, 1, 1}, 6)), 1, btVector3(btScalar(x), 0, btScalar(0.52)));
    world.run(0.5);
    EXPECT_TRUE(std::isfinite(world.bodies.back()->getWorldTransform().getOrigin().length())) << x;
  }
}

/// A world whose dispatcher nobody registered.
struct ForgottenWorld {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  std::shared_ptr<btCollisionShape> shape = makeShape(latticeBox({1, 1, 1}, 2));
  btRigidBody lower{0, nullptr, shape.get()};
  btRigidBody upper{1, nullptr, shape.get()};

  ForgottenWorld() {
    world.setGravity(btVector3(0, 0, btScalar(-9.81)));
    upper.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, 1)));
    world.addRigidBody(&lower);
    world.addRigidBody(&upper);
  }
  ~ForgottenWorld() {
    world.removeRigidBody(&upper);
    world.removeRigidBody(&lower);
  }
  void step(int count) {
    for (int i = 0; i < count; ++i) world.stepSimulation(btScalar(1) / 60, 0);
  }
};

/// Runs in a process of its own, in which nobody has registered a dispatcher.
void stepAnUnregisteredWorld() {
  ForgottenWorld().step(600);
  std::exit(0);
}

TEST(UnregisteredWorldDeathTest, SaysSo) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(stepAnUnregisteredWorld(), testing::ExitedWithCode(0),
              "^InnerSphere: No dispatcher was registered[^\n]*\n$");
}

TEST(UnregisteredWorld, BesideOneThatIsRegisteredSaysSoOnce) {
  for (const bool shared : {false, true}) {
    TestWorld registered;
    ForgottenWorld forgotten;
    registered.addFloor();
    const auto shape = shared ? forgotten.shape : makeShape(latticeBox({1, 1, 1}, 2));
    for (int i = 0; i < 20; ++i)
      registered.add(shape, 1, btVector3(btScalar(1.2 * (i % 5)), btScalar(1.2 * (i / 5)), btScalar(0.6)));
    const CaptureLog log;
    for (int i = 0; i < 6000; ++i) {
      registered.run(1.0 / 60);
      forgotten.step(1);
    }
    EXPECT_LT(forgotten.upper.getWorldTransform().getOrigin().z(), -100);
    EXPECT_GT(registered.bodies.back()->getWorldTransform().getOrigin().z(), 0.4);
    ASSERT_EQ(log.messages.size(), 1u) << shared;
    EXPECT_NE(log.messages[0].find("registerAlgorithm with the dispatcher of its world"), std::string::npos);
  }
}

TEST(UnregisteredWorld, IsNotSeenInOneThatIsRegistered) {
  TestWorld world;
  world.addFloor();
  const auto shape = makeShape(latticeBox({1, 1, 1}, 2));
  btRigidBody& falls = world.add(shape, 1, btVector3(0, 0, btScalar(0.6)));
  world.run(0.5);
  falls.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, 10000)));
  world.add(makeShape(latticeBox({1, 1, 1}, 2)), 0, btVector3(5, 0, 20));  // is met by nobody, and stays
  const CaptureLog log;
  world.run(40);
  EXPECT_LT(falls.getWorldTransform().getOrigin().z(), 9000);
  EXPECT_TRUE(log.messages.empty());
}

/// Shapes of a world that nobody registered are met by their triangles where Bullet can.
TEST(UnregisteredWorld, DoesNotSpeakOnceADispatcherIsRegistered) {
  TestWorld registered;
  const CaptureLog log;
  const auto shape = makeShape(latticeBox({1, 1, 1}, 2));
  btVector3 min, max;
  for (int i = 0; i < 5000; ++i) shape->getAabb(btTransform::getIdentity(), min, max);
  EXPECT_TRUE(log.messages.empty());
}

}  // namespace
}  // namespace innersphere::test
