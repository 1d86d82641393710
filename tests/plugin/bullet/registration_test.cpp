#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <new>
#include <optional>

#include <BulletCollision/CollisionShapes/btSdfCollisionShape.h>
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>

#include <LinearMath/btPoolAllocator.h>

#include "bullet/packing_pair_algorithm.hpp"
#include "bullet/registration.hpp"
#include "bullet_shapes.hpp"
#include "innersphere/error.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

ErrorCode codeOf(btDispatcher* dispatcher, const ContactOptions& options) {
  try {
    PackingCollisionAlgorithm::registerAlgorithm(dispatcher, options);
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "no error";
  return ErrorCode::cancelled;
}

TEST(Registration, AlgorithmFitsBulletsPool) {
  EXPECT_LE(sizeof(PairAlgorithm), 128u);
  btDefaultCollisionConfiguration configuration;
  EXPECT_GE(configuration.getCollisionAlgorithmPool()->getElementSize(),
            static_cast<int>(sizeof(PairAlgorithm)));
}

TEST(Registration, BadArgumentsAreNamed) {
  EXPECT_EQ(codeOf(nullptr, {}), ErrorCode::bad_argument);
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  ContactOptions options;
  options.stiffness = -1;
  EXPECT_EQ(codeOf(&dispatcher, options), ErrorCode::bad_argument);
  options = {};
  options.damping = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(codeOf(&dispatcher, options), ErrorCode::bad_argument);
  for (const double accuracy :
       {-0.001, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    options = {};
    options.accuracy = accuracy;
    EXPECT_EQ(codeOf(&dispatcher, options), ErrorCode::bad_argument) << accuracy;
  }
  if (!cudaAvailable()) {
    options = {};
    options.backend = Backend::cuda;
    EXPECT_EQ(codeOf(&dispatcher, options), ErrorCode::no_device);
  }
}

/// A dispatcher of the user's own from the ground up.
struct OtherDispatcher : btDispatcher {
  btCollisionAlgorithm* findAlgorithm(const btCollisionObjectWrapper*, const btCollisionObjectWrapper*,
                                      btPersistentManifold*, ebtDispatcherQueryType) override {
    return nullptr;
  }
  btPersistentManifold* getNewManifold(const btCollisionObject*, const btCollisionObject*) override {
    return nullptr;
  }
  void releaseManifold(btPersistentManifold*) override {}
  void clearManifold(btPersistentManifold*) override {}
  bool needsCollision(const btCollisionObject*, const btCollisionObject*) override { return false; }
  bool needsResponse(const btCollisionObject*, const btCollisionObject*) override { return false; }
  void dispatchAllCollisionPairs(btOverlappingPairCache*, const btDispatcherInfo&, btDispatcher*) override {}
  int getNumManifolds() const override { return 0; }
  btPersistentManifold* getManifoldByIndexInternal(int) override { return nullptr; }
  btPersistentManifold** getInternalManifoldPointer() override { return nullptr; }
  btPoolAllocator* getInternalManifoldPool() override { return nullptr; }
  const btPoolAllocator* getInternalManifoldPool() const override { return nullptr; }
  void* allocateCollisionAlgorithm(int) override { return nullptr; }
  void freeCollisionAlgorithm(void*) override {}
};

TEST(Registration, TakesADispatcherAsAWorldHoldsIt) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btCollisionWorld world(&dispatcher, &broadphase, &configuration);
  EXPECT_THROW(PackingCollisionAlgorithm::options(world.getDispatcher()), Error);
  ContactOptions options;
  options.stiffness = 321;
  PackingCollisionAlgorithm::registerAlgorithm(world.getDispatcher(), options);
  EXPECT_TRUE(PackingCollisionAlgorithm::isRegistered(world.getDispatcher()));
  EXPECT_TRUE(PackingCollisionAlgorithm::isRegistered(&dispatcher));
  EXPECT_EQ(PackingCollisionAlgorithm::options(world.getDispatcher()).stiffness, 321);
  PackingCollisionAlgorithm::unregisterAlgorithm(world.getDispatcher());
  EXPECT_FALSE(PackingCollisionAlgorithm::isRegistered(world.getDispatcher()));
  EXPECT_THROW(PackingCollisionAlgorithm::options(&dispatcher), Error);
  EXPECT_THROW(PackingCollisionAlgorithm::options(nullptr), Error);
}

TEST(Registration, ADispatcherOfAnotherKindIsAnError) {
  OtherDispatcher other;
  EXPECT_EQ(codeOf(&other, {}), ErrorCode::bad_argument);
  EXPECT_FALSE(PackingCollisionAlgorithm::isRegistered(&other));
  PackingCollisionAlgorithm::unregisterAlgorithm(&other);  // does nothing
}

TEST(Registration, CanBeAskedFor) {
  EXPECT_FALSE(PackingCollisionAlgorithm::isRegistered(nullptr));
  btDefaultCollisionConfiguration configuration;
  std::optional<btCollisionDispatcher> dispatcher(&configuration);
  btCollisionDispatcher other(&configuration);
  EXPECT_FALSE(PackingCollisionAlgorithm::isRegistered(&*dispatcher));
  PackingCollisionAlgorithm::registerAlgorithm(&*dispatcher);
  EXPECT_TRUE(PackingCollisionAlgorithm::isRegistered(&*dispatcher));
  EXPECT_FALSE(PackingCollisionAlgorithm::isRegistered(&other));
  dispatcher.emplace(&configuration);  // another one, at the same address
  EXPECT_FALSE(PackingCollisionAlgorithm::isRegistered(&*dispatcher));
  PackingCollisionAlgorithm::registerAlgorithm(&*dispatcher);
  EXPECT_TRUE(PackingCollisionAlgorithm::isRegistered(&*dispatcher));
  PackingCollisionAlgorithm::unregisterAlgorithm(&*dispatcher);
  EXPECT_FALSE(PackingCollisionAlgorithm::isRegistered(&*dispatcher));
}

TEST(Registration, AgainReplacesTheOptions) {
  ContactOptions soft;
  soft.stiffness = 500;  // a 1 kg unit cube sinks 9.81 / 500 m
  TestWorld world(soft);
  world.addFloor();
  btRigidBody& body = world.add(makeShape(latticeBox({1, 1, 1}, 8)), 1, btVector3(0, 0, btScalar(0.5)));
  body.setActivationState(DISABLE_DEACTIVATION);
  world.run(2);
  const double soft_depth = 0.5 - body.getWorldTransform().getOrigin().z();
  EXPECT_GT(soft_depth, 0.01);
  PackingCollisionAlgorithm::registerAlgorithm(&world.dispatcher);
  PackingCollisionAlgorithm::registerAlgorithm(&world.dispatcher);
  world.run(2);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.5, 0.005);
}

TEST(Registration, TwoWorldsDoNotMix) {
  ContactOptions soft;
  soft.stiffness = 500;
  TestWorld a(soft), b;
  const auto shape = makeShape(latticeBox({1, 1, 1}, 8));
  for (TestWorld* world : {&a, &b}) {
    world->addFloor();
    world->add(shape, 1, btVector3(0, 0, btScalar(0.5)));
    world->run(2);
  }
  EXPECT_LT(a.bodies.back()->getWorldTransform().getOrigin().z(), 0.49);
  EXPECT_NEAR(b.bodies.back()->getWorldTransform().getOrigin().z(), 0.5, 0.005);
}

TEST(Registration, CanBeTakenBackAndGivenAgain) {
  TestWorld world;
  world.addFloor();
  const auto shape = makeShape(latticeBox({1, 1, 1}, 4));
  PackingCollisionAlgorithm::unregisterAlgorithm(&world.dispatcher);
  btRigidBody& before = world.add(shape, 1, btVector3(0, 0, btScalar(0.6)));
  world.run(2);
  EXPECT_LT(before.getWorldTransform().getOrigin().z(), -1);  // as in a world that was never registered
  PackingCollisionAlgorithm::registerAlgorithm(&world.dispatcher);
  btRigidBody& after = world.add(shape, 1, btVector3(0, 0, btScalar(0.6)));
  world.run(2);
  EXPECT_NEAR(after.getWorldTransform().getOrigin().z(), 0.5, 0.005);
}

TEST(Registration, TakenBackItIsFreedWithTheLastPair) {
  std::weak_ptr<Registration> registration;
  {
    TestWorld world;
    registration = Registration::find(&world.dispatcher);
    world.addFloor();
    const auto shape = makeShape(latticeBox({1, 1, 1}, 4));
    world.add(shape, 1, btVector3(0, 0, btScalar(0.5)));
    world.add(shape, 1, btVector3(0, 0, btScalar(1.5)));
    world.run(0.1);
    EXPECT_GT(world.contactCount(), 0);
    PackingCollisionAlgorithm::unregisterAlgorithm(&world.dispatcher);
    PackingCollisionAlgorithm::unregisterAlgorithm(&world.dispatcher);
    world.run(0.1);  // pairs that Bullet knows go on
    EXPECT_NEAR(world.bodies.back()->getWorldTransform().getOrigin().z(), 1.5, 0.005);
    EXPECT_FALSE(registration.expired());
  }
  EXPECT_TRUE(registration.expired());
}

TEST(Registration, IsForgottenWhenTheDispatcherIsGone) {
  std::weak_ptr<Registration> registration;
  const btDispatcher* gone = nullptr;
  TestWorld other;
  {
    TestWorld world;
    gone = &world.dispatcher;
    registration = Registration::find(&world.dispatcher);
    world.addFloor();
    world.add(makeShape(latticeBox({1, 1, 1}, 4)), 1, btVector3(0, 0, btScalar(0.5)));
    world.run(0.1);
    EXPECT_GT(world.contactCount(), 0);
  }
  EXPECT_FALSE(registration.expired());  // nobody has told
  PackingCollisionAlgorithm::forget(gone);
  EXPECT_TRUE(registration.expired());
  PackingCollisionAlgorithm::forget(gone);
  PackingCollisionAlgorithm::forget(nullptr);
  EXPECT_TRUE(PackingCollisionAlgorithm::isRegistered(&other.dispatcher));
}

TEST(Registration, ForgettingDoesNotTouchTheDispatcher) {
  btDefaultCollisionConfiguration configuration;
  alignas(btCollisionDispatcher) unsigned char place[sizeof(btCollisionDispatcher)];
  auto* dispatcher = new (place) btCollisionDispatcher(&configuration);
  PackingCollisionAlgorithm::registerAlgorithm(dispatcher);
  const std::weak_ptr<Registration> first = Registration::find(dispatcher);
  dispatcher->~btCollisionDispatcher();
  std::fill(std::begin(place), std::end(place), static_cast<unsigned char>(0xab));
  PackingCollisionAlgorithm::forget(dispatcher);
  EXPECT_TRUE(first.expired());
  EXPECT_TRUE(std::all_of(std::begin(place), std::end(place), [](unsigned char c) { return c == 0xab; }));
  dispatcher = new (place) btCollisionDispatcher(&configuration);  // another one, at the same address
  PackingCollisionAlgorithm::registerAlgorithm(dispatcher);
  EXPECT_TRUE(PackingCollisionAlgorithm::isRegistered(dispatcher));
  PackingCollisionAlgorithm::unregisterAlgorithm(dispatcher);
  PackingCollisionAlgorithm::forget(dispatcher);  // does nothing
  dispatcher->~btCollisionDispatcher();
}

TEST(Registration, UnregisteredPackingStillMeetsConvexShapes) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity(btVector3(0, 0, -10));
  const auto floor_shape = makeShape(latticeBox({2, 2, 2}, 2));
  btRigidBody floor(0, nullptr, floor_shape.get());
  btSphereShape sphere(btScalar(0.5));
  btRigidBody ball(1, nullptr, &sphere, btVector3(1, 1, 1));
  ball.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, btScalar(1.6))));
  world.addRigidBody(&floor);
  world.addRigidBody(&ball);
  for (int i = 0; i < 120; ++i) world.stepSimulation(btScalar(1) / 60, 0);
  EXPECT_NEAR(ball.getWorldTransform().getOrigin().z(), 1.5, 0.05);
  world.removeRigidBody(&ball);
  world.removeRigidBody(&floor);
}

/// A shape of somebody else that uses our type number.
struct Foreign : btConcaveShape {
  Foreign() { m_shapeType = FAST_CONCAVE_MESH_PROXYTYPE; }
  void getAabb(const btTransform& t, btVector3& min, btVector3& max) const override {
    const btVector3 half(2, 2, btScalar(0.1));
    min = t.getOrigin() - half;
    max = t.getOrigin() + half;
  }
  void processAllTriangles(btTriangleCallback* callback, const btVector3&, const btVector3&) const override {
    btVector3 one[3] = {btVector3(-2, -2, 0), btVector3(2, -2, 0), btVector3(2, 2, 0)};
    btVector3 two[3] = {btVector3(-2, -2, 0), btVector3(2, 2, 0), btVector3(-2, 2, 0)};
    callback->processTriangle(one, 0, 0);
    callback->processTriangle(two, 0, 1);
  }
  void setLocalScaling(const btVector3&) override {}
  const btVector3& getLocalScaling() const override {
    static const btVector3 one(1, 1, 1);
    return one;
  }
  void calculateLocalInertia(btScalar, btVector3& inertia) const override { inertia.setZero(); }
  const char* getName() const override { return "Foreign"; }
};

TEST(Registration, ForeignShapesOfOurTypeKeepTheirAlgorithm) {
  TestWorld world;
  world.add(std::make_shared<Foreign>(), 0, btVector3(0, 0, 0));
  btRigidBody& ball =
      world.add(std::make_shared<btSphereShape>(btScalar(0.5)), 1, btVector3(0, 0, btScalar(0.6)));
  world.run(2);
  EXPECT_NEAR(ball.getWorldTransform().getOrigin().z(), 0.5, 0.05);
  // And a packing rests on it through its triangles.
  btRigidBody& box =
      world.add(makeShape(latticeBox({1, 1, 1}, 4)), 1, btVector3(btScalar(1.2), 0, btScalar(0.6)));
  world.run(2);
  EXPECT_NEAR(box.getWorldTransform().getOrigin().z(), 0.5, 0.005);
}

TEST(Registration, SdfShapesKeepTheirRow) {
  // An empty btSdfCollisionShape answers no query; the point is that nobody casts a packing to it.
  TestWorld world;
  world.add(std::make_shared<btSdfCollisionShape>(), 0, btVector3(0, 0, 0));
  world.add(makeShape(latticeBox({1, 1, 1}, 2)), 1, btVector3(0, 0, 0));
  world.add(std::make_shared<btSphereShape>(btScalar(0.5)), 1, btVector3(0, 0, btScalar(0.2)));
  world.run(0.1);
  EXPECT_GT(world.contactCount(), 0);  // of the packing with the sphere
}

/// A slope, on which bodies roll, slide and lie.
TEST(Registration, ConvexBodiesOnSdfShapesKeepTheirBits) {
  const auto places = [](bool registered) {
    TestWorld world;
    if (!registered) PackingCollisionAlgorithm::unregisterAlgorithm(&world.dispatcher);
    world.add(makeSdf(4, 2, [](const btVector3& p) { return double(p.z() * 0.8 + p.x() * 0.6); }), 0,
              btVector3(0, 0, 0));
    btRigidBody& ball = world.add(std::make_shared<btSphereShape>(btScalar(0.5)), 1, btVector3(0, 0, 1));
    btRigidBody& box = world.add(std::make_shared<btBoxShape>(btVector3(1, 1, 1) / 2), 1, btVector3(0, 2, 1));
    world.run(0.5);
    EXPECT_GT(world.contactCount(), 0);
    return std::pair(ball.getWorldTransform().getOrigin(), box.getWorldTransform().getOrigin());
  };
  EXPECT_EQ(places(true), places(false));
}

TEST(Registration, AfterGImpact) {
  TestWorld world;
  btGImpactCollisionAlgorithm::registerAlgorithm(&world.dispatcher);
  PackingCollisionAlgorithm::registerAlgorithm(&world.dispatcher);
  btTriangleMesh triangles;
  const btScalar s = 2;
  triangles.addTriangle(btVector3(-s, -s, 0), btVector3(s, -s, 0), btVector3(s, s, 0));
  triangles.addTriangle(btVector3(-s, -s, 0), btVector3(s, s, 0), btVector3(-s, s, 0));
  auto mesh = std::make_shared<btGImpactMeshShape>(&triangles);
  mesh->updateBound();
  world.add(mesh, 0, btVector3(0, 0, 0));
  btRigidBody& box = world.add(makeShape(latticeBox({1, 1, 1}, 4)), 1, btVector3(0, 0, btScalar(0.6)));
  world.run(2);
  EXPECT_NEAR(box.getWorldTransform().getOrigin().z(), 0.5, 0.005);
}

}  // namespace
}  // namespace innersphere::test
