// Packings in every kind of world that Bullet has.
//
// What Bullet does that a collision algorithm can fall over, and the test that would show it:
// clang-format off
//   elements of its pool have a fixed size, unchecked    Registration.AlgorithmFitsBulletsPool, Worlds.APoolWithTooSmallElements*
//   the pool of algorithms overflows to the heap         Worlds.MoreAlgorithmsThanThePoolHolds
//   manifolds may not be had                             Worlds.SlavesToAUsersPoolOfManifolds
//   normals follow the order of a manifold's bodies      ShapeMatrix, Callbacks.ManifoldsNameTheirBodies*
//   child algorithms own or clear manifolds              ShapeMatrix, CallbacksOn.PointsAreFewAndKeepTheirImpulses
//   Mt cannot release a manifold in the same dispatch    ShapeMatrix (Mt), Worlds.Multithreaded, Batch (Mt)
//   Mt collides pairs by several threads                 ConcurrentDispatch, ConcurrentPenalty
//   type numbers are few, and one is shared with SDF     Shape.IsRecognisedAmongOthersOfItsType, Registration.SdfShapes*, Foreign*
//   GImpact overwrites its rows                          Registration.AfterGImpact, Worlds.GImpactRegisteredLater*
//   contactTest needs its own registration               ShapeMatrix.QueriesFindIt, ContactQuery
//   compounds are walked by Bullet, with scaling         ShapeMatrix (nested), Worlds.ACompoundScalesItsPackings, Batch.Children*
//   contactTest walks compounds with a step's algorithms ReadingAWorld
//   soft bodies, rays, sweeps, CCD use the triangles     Worlds.ClothFallsOnAPacking, AFastBall*, Shape.RaysAndSweeps*
//   characters dispatch a cache of their own             Worlds.ACharacterStands*, Penalty.ActsOnceAStep*
//   one slot for tick and near callbacks                 Worlds.TickCallbacks*, Batch.NearCallbacksStillFilter
//   islands follow boxes, too wide ones are disabled     Worlds.WhatMovesBesideASleeper*, APackingThatIsTooWide*
//   there is a continuous dispatch                       Worlds.ContinuousDispatchFindsNoTimeOfImpact
//   the solver loses springs deeper than 4 cm            ContactLaw.SoftContactDeeperThanTheSplitImpulseThreshold
//   forces add up over substeps, impulses do not         Penalty.SubstepsOfOneCallDoNotAddUp
//   multi-body links take no impulses, nor split ones    MultiBody
//   old points live on, new ones lose warm starting      CallbacksOn.PointsThatWereNotFoundAgain*, PointsAreFew*
//   the breaking threshold merges points                 Shape.ContactThresholdFollowsTheSpheresNotTheSize
//   the shape of a living pair may change                Robustness.ChangedShapeOfALivingPair
//   importers know only Bullet's shapes                  Serialization
//   a user's own contact law or material callback        ContactLaw.UsersOwnStiffnessIsKept, MaterialCallbackSeesEveryPoint
// clang-format on
#include <gtest/gtest.h>

#include <BulletCollision/CollisionDispatch/btCollisionDispatcherMt.h>
#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletDynamics/Character/btKinematicCharacterController.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolverMt.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <LinearMath/btPoolAllocator.h>
#include <LinearMath/btThreads.h>

#include "bullet_shapes.hpp"
#include "innersphere/error.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

std::shared_ptr<PackingShape> cube() {
  return makeShape(latticeBox({1, 1, 1}, 6));
}

/// Bodies in a world that somebody else has made; taken out again at the end.
class Guests {
 public:
  explicit Guests(btDynamicsWorld& world) : world_(world) { world.setGravity(btVector3(0, 0, -10)); }
  ~Guests() {
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }
  btRigidBody& add(std::shared_ptr<btCollisionShape> shape, double mass, const btVector3& position) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(btScalar(mass), inertia);
    bodies_.push_back(std::make_unique<btRigidBody>(btScalar(mass), nullptr, shape.get(), inertia));
    bodies_.back()->setWorldTransform(btTransform(btQuaternion::getIdentity(), position));
    world_.addRigidBody(bodies_.back().get());
    shapes_.push_back(std::move(shape));
    return *bodies_.back();
  }
  void run(double seconds) {
    for (int i = 0; i < seconds * 60; ++i) world_.stepSimulation(btScalar(1) / 60, 0);
  }
  /// Three cubes on top of each other on a packing.
  void expectStackHolds() {
    add(makeShape(latticeBox({3, 3, 2}, 12)), 0, btVector3(0, 0, -1));
    const auto shape = cube();
    std::vector<btRigidBody*> stack;
    for (int i = 0; i < 3; ++i) stack.push_back(&add(shape, 1, btVector3(0, 0, btScalar(0.52 + 1.02 * i))));
    run(2);
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(stack[i]->getWorldTransform().getOrigin().z(), 0.5 + i, 0.01) << i;
  }

 private:
  btDynamicsWorld& world_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::shared_ptr<btCollisionShape>> shapes_;
};

TEST(Worlds, Multithreaded) {
  // Debian's Bullet has no task scheduler but the sequential one: these are its multithreaded classes, on one
  // thread.
  btSetTaskScheduler(btGetSequentialTaskScheduler());
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcherMt dispatcher(&configuration);
  PackingCollisionAlgorithm::registerAlgorithm(&dispatcher);
  btDbvtBroadphase broadphase;
  btConstraintSolverPoolMt solvers(2);
  btSequentialImpulseConstraintSolverMt large;
  btDiscreteDynamicsWorldMt world(&dispatcher, &broadphase, &solvers, &large, &configuration);
  Guests(world).expectStackHolds();
}

TEST(Worlds, Mlcp) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  PackingCollisionAlgorithm::registerAlgorithm(&dispatcher);
  btDbvtBroadphase broadphase;
  btDantzigSolver dantzig;
  btMLCPSolver solver(&dantzig);
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  Guests(world).expectStackHolds();
}

TEST(Worlds, SweepAndPrune) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  PackingCollisionAlgorithm::registerAlgorithm(&dispatcher);
  btAxisSweep3 broadphase(btVector3(-10, -10, -10), btVector3(10, 10, 10));
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  Guests(world).expectStackHolds();
}

/// Soft bodies walk the packing's triangles: their rows of the table are left to Bullet.
TEST(Worlds, ClothFallsOnAPacking) {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  PackingCollisionAlgorithm::registerAlgorithm(&dispatcher);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  {
    Guests guests(world);
    world.getWorldInfo().m_gravity.setValue(0, 0, -10);
    world.getWorldInfo().m_sparsesdf.Initialize();
    guests.add(cube(), 0, btVector3(0, 0, btScalar(-0.5)));
    const btScalar s = btScalar(0.4), z = btScalar(0.2);
    btSoftBody* cloth =
        btSoftBodyHelpers::CreatePatch(world.getWorldInfo(), btVector3(-s, -s, z), btVector3(s, -s, z),
                                       btVector3(-s, s, z), btVector3(s, s, z), 9, 9, 0, true);
    world.addSoftBody(cloth);
    guests.run(1);
    btScalar lowest = 1;
    for (int i = 0; i < cloth->m_nodes.size(); ++i) lowest = btMin(lowest, cloth->m_nodes[i].m_x.z());
    EXPECT_GT(lowest, -0.1);
    world.removeSoftBody(cloth);  // which would kick what stands on it
    delete cloth;
    guests.expectStackHolds();
  }
}

TEST(Worlds, GImpactRegisteredLaterMeetsTheTriangles) {
  TestWorld world;
  btGImpactCollisionAlgorithm::registerAlgorithm(&world.dispatcher);  // takes the pairs with its own shapes
  const BulletShape ground = makeBulletShape("gimpact");
  world.add(ground.shape, 0, ground.place.getOrigin());
  btRigidBody& body = world.add(cube(), 1, btVector3(0, 0, btScalar(0.55)));
  btRigidBody& other = world.add(cube(), 1, btVector3(0, 0, btScalar(1.6)));
  world.run(1.5);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.5, 0.05);
  EXPECT_NEAR(other.getWorldTransform().getOrigin().z() - body.getWorldTransform().getOrigin().z(), 1, 0.01);
}

TEST(Worlds, AMovingGImpactMeshRestsOnAPackingAndCarriesOne) {
  TestWorld world;
  btGImpactCollisionAlgorithm::registerAlgorithm(&world.dispatcher);
  PackingCollisionAlgorithm::registerAlgorithm(&world.dispatcher);
  world.add(makeShape(latticeBox({6, 6, 1}, 6)), 0, btVector3(0, 0, btScalar(-0.5)));
  const BulletShape mesh = makeBulletShape("gimpact");  // half as high as wide: 4 x 4 x 2
  btRigidBody& below = world.add(mesh.shape, 4, btVector3(0, 0, btScalar(1.05)));
  btRigidBody& above = world.add(cube(), 1, btVector3(0, 0, btScalar(2.6)));
  world.run(2);
  EXPECT_NEAR(below.getWorldTransform().getOrigin().z(), 1, 0.005);
  EXPECT_NEAR(above.getWorldTransform().getOrigin().z(), 2.5, 0.01);
  for (const btRigidBody* body : {&below, &above}) {
    EXPECT_LT(tiltDegrees(*body), 0.5);
    EXPECT_LT(body->getLinearVelocity().length(), 0.01);
  }
}

/// The character has a pair cache of its own and dispatches it in between.
TEST(Worlds, ACharacterStandsOnAPackingAndMeetsOthers) {
  TestWorld world;
  btGhostPairCallback callback;
  world.broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(&callback);
  world.add(makeShape(latticeBox({6, 6, 1}, 4)), 0, btVector3(0, 0, btScalar(-0.5)));
  world.add(cube(), 0, btVector3(2, 0, btScalar(0.5)));
  btCapsuleShapeZ capsule(btScalar(0.3), btScalar(1));
  btPairCachingGhostObject ghost;
  ghost.setCollisionShape(&capsule);
  ghost.setCollisionFlags(btCollisionObject::CF_CHARACTER_OBJECT);
  ghost.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, btScalar(1.2))));
  btKinematicCharacterController walker(&ghost, &capsule, btScalar(0.2), btVector3(0, 0, 1));
  world.world.addCollisionObject(&ghost, btBroadphaseProxy::CharacterFilter, btBroadphaseProxy::AllFilter);
  world.world.addAction(&walker);
  world.run(1);
  EXPECT_NEAR(ghost.getWorldTransform().getOrigin().z(), 0.8, 0.1);
  walker.setWalkDirection(btVector3(btScalar(0.03), 0, 0));
  world.run(2);
  EXPECT_GT(ghost.getWorldTransform().getOrigin().x(), 1);
  EXPECT_LT(ghost.getWorldTransform().getOrigin().x(), 1.3);  // the cube stands in the way
  world.world.removeAction(&walker);
  world.world.removeCollisionObject(&ghost);
}

/// Bullet multiplies the scaling of children by that of the compound.
TEST(Worlds, ACompoundScalesItsPackings) {
  TestWorld world;
  world.addFloor();
  const auto child = cube();
  auto compound = std::make_shared<btCompoundShape>();
  compound->addChildShape(btTransform::getIdentity(), child.get());
  compound->setLocalScaling(btVector3(2, 2, 2));
  compound->setLocalScaling(btVector3(1, 1, 1));
  compound->setLocalScaling(btVector3(2, 2, 2));
  EXPECT_NEAR(child->getLocalScaling().x(), 2, 1e-6);
  btRigidBody& body = world.add(compound, 1, btVector3(0, 0, btScalar(1.02)));
  world.run(1);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 1, 0.01);
}

/// The packing throws before the compound has changed.
TEST(Worlds, StretchingACompoundOfAPackingIsAnError) {
  TestWorld world;
  world.addFloor();
  const auto child = cube();
  auto compound = std::make_shared<btCompoundShape>();
  compound->addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, 1)), child.get());
  btRigidBody& body = world.add(compound, 1, btVector3(0, 0, btScalar(-0.48)));
  try {
    compound->setLocalScaling(btVector3(2, 1, 1));
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
  }
  EXPECT_EQ(compound->getLocalScaling(), btVector3(1, 1, 1));
  EXPECT_EQ(child->getLocalScaling(), btVector3(1, 1, 1));
  world.run(1);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), -0.5, 0.005);
  compound->setLocalScaling(btVector3(2, 2, 2));
  EXPECT_NEAR(child->getLocalScaling().x(), 2, 1e-6);
}

/// Continuous collision detection of others goes through the packing's triangles.
TEST(Worlds, AFastBallDoesNotPassThrough) {
  TestWorld world;
  world.world.setGravity(btVector3(0, 0, 0));
  world.add(makeShape(latticeBox({2, 2, btScalar(0.1)}, 2)), 0, btVector3(0, 0, 0));
  btRigidBody& ball = world.add(std::make_shared<btSphereShape>(btScalar(0.05)), 1, btVector3(0, 0, 2));
  ball.setCcdMotionThreshold(btScalar(0.01));
  ball.setCcdSweptSphereRadius(btScalar(0.04));
  ball.setLinearVelocity(btVector3(0, 0, -200));
  world.run(0.1);
  EXPECT_GT(ball.getWorldTransform().getOrigin().z(), 0);
}

/// Bullet's islands are of bodies whose boxes overlap, and share their sleep.
TEST(Worlds, WhatMovesBesideASleeperDoesNotWakeIt) {
  TestWorld world;
  world.addFloor();
  btRigidBody& sleeper = world.add(cube(), 1, btVector3(0, 0, btScalar(0.5)));
  world.run(3);
  ASSERT_EQ(sleeper.getActivationState(), ISLAND_SLEEPING);
  btRigidBody& other = world.add(cube(), 1, btVector3(btScalar(1.15), 0, btScalar(0.5)));
  for (int i = 0; i < 60; ++i) {
    other.setAngularVelocity(btVector3(0, 0, btScalar(i % 2 == 0 ? 0.1 : -0.1)));
    world.run(1.0 / 60);
    ASSERT_EQ(sleeper.getActivationState(), ISLAND_SLEEPING) << i;
  }
}

/// Bullet disables what is wider than 1,000 km.
TEST(Worlds, APackingThatIsTooWideForBulletLeavesTheOthersAlone) {
  TestWorld world;
  world.addFloor();
  const auto wide = cube();
  wide->setLocalScaling(btVector3(1, 1, 1) * btScalar(1e6));
  btRigidBody& body = world.add(wide, 1, btVector3(0, 0, btScalar(6e5)));
  btRigidBody& other = world.add(cube(), 1, btVector3(btScalar(5e5), 0, btScalar(0.55)));
  world.run(1);
  EXPECT_EQ(body.getActivationState(), DISABLE_SIMULATION);
  EXPECT_EQ(body.getWorldTransform().getOrigin().z(), btScalar(6e5));
  EXPECT_NEAR(other.getWorldTransform().getOrigin().z(), 0.5, 0.005);
}

/// There is no continuous detection for packings: all of the step is free.
TEST(Worlds, ContinuousDispatchFindsNoTimeOfImpact) {
  TestWorld world;
  world.add(cube(), 0, btVector3(0, 0, 0));
  world.add(cube(), 1, btVector3(0, 0, btScalar(0.99)));
  world.world.performDiscreteCollisionDetection();
  ASSERT_GT(world.contactCount(), 0);
  const int points = world.contactCount();
  btDispatcherInfo& info = world.world.getDispatchInfo();
  info.m_dispatchFunc = btDispatcherInfo::DISPATCH_CONTINUOUS;
  info.m_timeOfImpact = 1;
  world.world.performDiscreteCollisionDetection();
  EXPECT_EQ(info.m_timeOfImpact, 1);
  EXPECT_EQ(world.contactCount(), points);
}

TEST(Worlds, SlavesToAUsersPoolOfManifolds) {
  // One manifold and no more: Bullet's own algorithms go without, too.
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 1;
  btDefaultCollisionConfiguration configuration(info);
  btCollisionDispatcher dispatcher(&configuration);
  dispatcher.setDispatcherFlags(btCollisionDispatcher::CD_DISABLE_CONTACTPOOL_DYNAMIC_ALLOCATION);
  PackingCollisionAlgorithm::registerAlgorithm(&dispatcher);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  Guests guests(world);
  guests.add(makeShape(latticeBox({3, 3, 2}, 6)), 0, btVector3(0, 0, -1));
  for (int i = 0; i < 2; ++i) guests.add(cube(), 1, btVector3(btScalar(-0.7 + 1.4 * i), 0, btScalar(0.5)));
  guests.run(0.2);
  EXPECT_EQ(dispatcher.getNumManifolds(), 1);
}

TEST(Worlds, APoolWithTooSmallElementsIsAnError) {
  btPoolAllocator pool(16, 8);
  btDefaultCollisionConstructionInfo info;
  info.m_collisionAlgorithmPool = &pool;
  btDefaultCollisionConfiguration configuration(info);
  btCollisionDispatcher dispatcher(&configuration);
  try {
    PackingCollisionAlgorithm::registerAlgorithm(&dispatcher);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    EXPECT_NE(std::string(error.what()).find("m_customCollisionAlgorithmMaxElementSize"), std::string::npos);
  }
}

TEST(Worlds, MoreAlgorithmsThanThePoolHolds) {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 1;
  btDefaultCollisionConfiguration configuration(info);
  btCollisionDispatcher dispatcher(&configuration);
  PackingCollisionAlgorithm::registerAlgorithm(&dispatcher);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  Guests(world).expectStackHolds();
}

/// Bullet has one slot for each tick callback, and they share one pointer.
TEST(Worlds, TickCallbacksAndUserInfoAreTheUsers) {
  TestWorld world;
  int ticks = 0;
  world.world.setInternalTickCallback(
      [](btDynamicsWorld* w, btScalar) { ++*static_cast<int*>(w->getWorldUserInfo()); }, &ticks);
  world.addFloor();
  world.add(cube(), 1, btVector3(0, 0, btScalar(0.5)));
  world.run(0.5);
  EXPECT_EQ(ticks, 30);
  EXPECT_EQ(world.world.getWorldUserInfo(), &ticks);
}

TEST(Worlds, DeterministicPairsMakeRecreatedWorldsEqual) {
  const auto places = [] {
    TestWorld world;
    world.world.getDispatchInfo().m_deterministicOverlappingPairs = true;
    world.addFloor();
    const auto shape = cube();
    for (int i = 0; i < 6; ++i) {
      world.add(shape, 1, btVector3(btScalar(0.2 * (i % 2)), btScalar(0.1 * i), btScalar(0.6 + 1.02 * i)));
    }
    world.run(1.5);
    std::vector<btVector3> all;
    for (const auto& body : world.bodies) all.push_back(body->getWorldTransform().getOrigin());
    return all;
  };
  EXPECT_EQ(places(), places());
}

}  // namespace
}  // namespace innersphere::test
