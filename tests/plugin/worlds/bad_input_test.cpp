// Worlds that are not as they should be.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>

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
  explicit ForgottenWorld(std::shared_ptr<btCollisionShape> of_upper = nullptr)
      : upper_shape(of_upper ? std::move(of_upper) : shape) {
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

  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  std::shared_ptr<btCollisionShape> shape = makeShape(latticeBox({1, 1, 1}, 2));
  std::shared_ptr<btCollisionShape> upper_shape;
  btRigidBody lower{0, nullptr, shape.get()};
  btRigidBody upper{1, nullptr, upper_shape.get()};
};

/// Runs in a process of its own, in which nobody has registered a dispatcher.
void stepAnUnregisteredWorld() {
  ForgottenWorld().step(200);
  std::exit(0);
}

TEST(UnregisteredWorldDeathTest, SaysSo) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(stepAnUnregisteredWorld(), testing::ExitedWithCode(0),
              "^InnerSphere: No dispatcher was registered[^\n]*\n$");
}

std::shared_ptr<PackingShape> namedCube(const std::string& name) {
  Packing packing = latticeBox({1, 1, 1}, 2);
  packing.provenance.source = name;
  return makeShape(packing);
}

TEST(UnregisteredWorld, NamesThePackingWhoseTrianglesBulletAsksFor) {
  const TestWorld registered;
  for (const bool compound : {false, true}) {
    std::shared_ptr<btCollisionShape> box = std::make_shared<btBoxShape>(btVector3(1, 1, 1) / 2), shape = box;
    if (compound) {
      auto parent = std::make_shared<btCompoundShape>();
      parent->addChildShape(btTransform::getIdentity(), box.get());
      shape = parent;
    }
    const CaptureLog log;
    ForgottenWorld forgotten(shape);
    forgotten.shape = namedCube("bunny.obj");
    forgotten.lower.setCollisionShape(forgotten.shape.get());
    forgotten.step(60);
    ASSERT_EQ(log.messages.size(), 1u) << compound;
    EXPECT_NE(log.messages[0].find("\"bunny.obj\""), std::string::npos);
    EXPECT_NE(log.messages[0].find("registerAlgorithm"), std::string::npos);
    forgotten.step(60);
    EXPECT_EQ(log.messages.size(), 1u);
    forgotten.world.removeRigidBody(&forgotten.upper);
    forgotten.world.addRigidBody(&forgotten.upper);
  }
}

TEST(UnregisteredWorld, IsNotSeenInOneThatIsRegistered) {
  const CaptureLog log;
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  PackingCollisionAlgorithm::registerAlgorithm(&dispatcher);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.getWorldInfo().m_sparsesdf.Initialize();
  const auto cube = namedCube("cube");
  btRigidBody ground(0, nullptr, cube.get()), other(1, nullptr, cube.get());
  btBoxShape box(btVector3(1, 1, 1) / 2);
  btRigidBody convex(1, nullptr, &box);
  btSphereShape small(btScalar(0.1));
  btRigidBody bullet(1, nullptr, &small);  // continuous collision detection sweeps it
  bullet.setCcdMotionThreshold(btScalar(0.01));
  bullet.setCcdSweptSphereRadius(btScalar(0.08));
  bullet.setLinearVelocity(btVector3(0, 0, -100));
  btRigidBody* const bodies[] = {&ground, &other, &convex, &bullet};
  const btVector3 places[] = {btVector3(0, 0, 0), btVector3(0, 0, 1), btVector3(0, 0, 2),
                              btVector3(btScalar(0.4), btScalar(0.4), 5)};
  for (int i = 0; i < 4; ++i) {
    bodies[i]->setWorldTransform(btTransform(btQuaternion::getIdentity(), places[i]));
    world.addRigidBody(bodies[i]);
  }
  const btScalar s = btScalar(0.6), z = btScalar(0.6);
  btSoftBody* cloth =
      btSoftBodyHelpers::CreatePatch(world.getWorldInfo(), btVector3(-s, -s, z), btVector3(s, -s, z),
                                     btVector3(-s, s, z), btVector3(s, s, z), 5, 5, 0, true);
  world.addSoftBody(cloth);
  struct AnyContact : btCollisionWorld::ContactResultCallback {
    btScalar addSingleResult(btManifoldPoint&, const btCollisionObjectWrapper*, int, int,
                             const btCollisionObjectWrapper*, int, int) override {
      return 0;
    }
  } contact;
  for (int i = 0; i < 90; ++i) {
    world.stepSimulation(btScalar(1) / 60, 0);
    btCollisionWorld::ClosestRayResultCallback ray(btVector3(0, 0, 9), btVector3(0, 0, -9));
    world.rayTest(ray.m_rayFromWorld, ray.m_rayToWorld, ray);
    btCollisionWorld::ClosestConvexResultCallback sweep(ray.m_rayFromWorld, ray.m_rayToWorld);
    world.convexSweepTest(&small, btTransform(btQuaternion::getIdentity(), ray.m_rayFromWorld),
                          btTransform(btQuaternion::getIdentity(), ray.m_rayToWorld), sweep);
    world.contactTest(&convex, contact);
  }
  world.removeSoftBody(cloth);
  delete cloth;
  for (btRigidBody* body : bodies) world.removeRigidBody(body);
  EXPECT_TRUE(log.messages.empty()) << log.messages[0];
}

TEST(UnregisteredWorld, DoesNotSpeakOnceADispatcherIsRegistered) {
  TestWorld registered;
  const CaptureLog log;
  const auto shape = makeShape(latticeBox({1, 1, 1}, 2));
  btVector3 min, max;
  for (int i = 0; i < 5000; ++i) shape->getAabb(btTransform::getIdentity(), min, max);
  EXPECT_TRUE(log.messages.empty());
}

/// Runs in a process of its own: bodies that are made before the dispatcher is registered are no alarm.
void addBodiesBeforeRegistering() {
  ForgottenWorld forgotten;
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  for (int i = 0; i < 200; ++i) {
    bodies.push_back(std::make_unique<btRigidBody>(btScalar(1), nullptr, forgotten.shape.get()));
    bodies.back()->setWorldTransform(
        btTransform(btQuaternion::getIdentity(), btVector3(btScalar(2 * i), 9, 0)));
    forgotten.world.addRigidBody(bodies.back().get());
  }
  PackingCollisionAlgorithm::registerAlgorithm(forgotten.world.getDispatcher());
  forgotten.step(10);
  std::fputs("done\n", stderr);
  std::_Exit(0);
}

TEST(UnregisteredWorldDeathTest, IsSilentWhereRegistrationComesAfterTheBodies) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(addBodiesBeforeRegistering(), testing::ExitedWithCode(0), "^done\n$");
}

}  // namespace
}  // namespace innersphere::test
