// How contact is made: options, numbers of spheres, backends and threads.
#include <gtest/gtest.h>

#include <BulletCollision/CollisionDispatch/btCollisionDispatcherMt.h>
#include <LinearMath/btThreads.h>
#include <cstdio>
#include <string>

#include "innersphere/batched_dispatcher.hpp"
#include "innersphere/error.hpp"
#include "innersphere/log.hpp"
#include "innersphere/substep_solver.hpp"
#include "recipes/recipe_world.hpp"

namespace innersphere::recipes {
namespace {

TEST(Recipes, AStiffnessSaysHowDeepABodySinks) {
  RecipeWorld<> simulation;
  auto& dispatcher = simulation.dispatcher;
  // [snippet options]
  innersphere::ContactOptions options;
  options.stiffness = 1e5;  // [N/m^3]: volume now decides how hard bodies push
  options.damping = 0.5;
  innersphere::PackingCollisionAlgorithm::registerAlgorithm(&dispatcher, options);
  // [snippet]
  PackingShape shape(boxModel({1, 1, 1}));
  const btRigidBody& body = simulation.add(shape, 1000, btVector3(0, 0, btScalar(0.5)));
  simulation.run(4);
  // weight = stiffness x area x depth; 256 spheres find a third more or less
  EXPECT_NEAR(0.5 - body.getWorldTransform().getOrigin().z(), 1000 * 9.81 / 1e5, 0.04);
}

TEST(Recipes, OneLinePreparesAWorld) {
  RecipeWorld<> simulation;
  auto& world = simulation.world;
  world.getSolverInfo().m_solverMode &= ~SOLVER_USE_2_FRICTION_DIRECTIONS;
  const innersphere::ContactOptions options;
  // [snippet prepare]
  innersphere::PackingCollisionAlgorithm::prepareWorld(world, options);  // or without options
  // [snippet]
  EXPECT_TRUE(PackingCollisionAlgorithm::isRegistered(&simulation.dispatcher));
  EXPECT_NE(world.getSolverInfo().m_solverMode & SOLVER_USE_2_FRICTION_DIRECTIONS, 0);
  PackingShape shape(torusModel());
  const btRigidBody& body = simulation.add(shape, 1, btVector3(0, 0, btScalar(0.1)));
  simulation.run(2);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), kTubeRadius, 0.001);
}

TEST(Recipes, ASolverOfItsOwnStandsHeavyOnLight) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  // [snippet substeps]
  innersphere::SubstepSolver solver;  // in place of btSequentialImpulseConstraintSolver
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  innersphere::PackingCollisionAlgorithm::prepareWorld(world);
  // [snippet]
  world.setGravity(btVector3(0, 0, btScalar(-9.81)));
  btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  PackingShape box(boxModel({1, 1, 1}));
  btVector3 inertia;
  box.calculateLocalInertia(1, inertia);
  btRigidBody floor(0, nullptr, &plane), light(1, nullptr, &box, inertia),
      heavy(100, nullptr, &box, 100 * inertia);
  light.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, btScalar(0.5))));
  heavy.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, btScalar(1.5))));
  for (btRigidBody* body : {&floor, &light, &heavy}) world.addRigidBody(body);
  for (int i = 0; i < 120; ++i) world.stepSimulation(btScalar(1) / 60, 0);
  EXPECT_NEAR(heavy.getWorldTransform().getOrigin().z(), 1.5, 0.005);
  for (btRigidBody* body : {&floor, &light, &heavy}) world.removeRigidBody(body);
  PackingCollisionAlgorithm::unregisterAlgorithm(&dispatcher);
}

TEST(Recipes, AShapeHasOptionsOfItsOwn) {
  RecipeWorld<> simulation;
  PackingCollisionAlgorithm::registerAlgorithm(&simulation.dispatcher);
  const std::shared_ptr<const CollisionModel> model = boxModel({1, 1, 1});
  PackingShape shape(model);
  // [snippet options of a shape]
  innersphere::ContactOptions soft;
  soft.stiffness = 1e5;
  innersphere::PackingShape cushion(model);
  cushion.setContactOptions(soft);  // for all bodies with this shape
  // [snippet]
  const btRigidBody& hard_body = simulation.add(shape, 1000, btVector3(-2, 0, btScalar(0.5)));
  const btRigidBody& soft_body = simulation.add(cushion, 1000, btVector3(2, 0, btScalar(0.5)));
  simulation.run(4);
  EXPECT_NEAR(hard_body.getWorldTransform().getOrigin().z(), 0.5, 0.001);
  EXPECT_NEAR(0.5 - soft_body.getWorldTransform().getOrigin().z(), 1000 * 9.81 / 1e5, 0.04);
}

TEST(Recipes, AccuracyChoosesTheSpheres) {
  RecipeWorld<> simulation;
  auto& dispatcher = simulation.dispatcher;
  PackingShape shape(torusModel());
  // [snippet spheres]
  innersphere::ContactOptions options;
  options.accuracy = 0.005;  // [m]: each pair takes as many spheres as this needs
  innersphere::PackingCollisionAlgorithm::registerAlgorithm(&dispatcher, options);

  shape.setSphereCount(128);  // or by hand, for all bodies with this shape
  // [snippet]
  const btRigidBody& body = simulation.add(shape, 1, btVector3(0, 0, btScalar(0.1)));
  simulation.run(2);
  EXPECT_EQ(shape.sphereCount(), 128u);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), kTubeRadius, 0.001);
}

TEST(Recipes, CudaIsAskedForByName) {
  RecipeWorld<> simulation;
  auto& dispatcher = simulation.dispatcher;
  bool is_on_device = false;
  // [snippet cuda]
  innersphere::ContactOptions options;
  options.backend = innersphere::Backend::cuda;  // automatic decides by the amount of work
  try {
    innersphere::PackingCollisionAlgorithm::registerAlgorithm(&dispatcher, options);
    is_on_device = true;
  } catch (const innersphere::Error& error) {  // no_device: the message says why
    std::fprintf(stderr, "%s\n", error.what());
  }
  // [snippet]
  EXPECT_EQ(is_on_device, cudaAvailable());
  EXPECT_EQ(PackingCollisionAlgorithm::isRegistered(&dispatcher), is_on_device);
}

/// Where three tori are that fell on each other.
template <class Simulation>
std::vector<btScalar> heapOf(Simulation& simulation) {
  PackingShape shape(torusModel());
  std::vector<btRigidBody*> bodies;
  for (int i = 0; i < 3; ++i)
    bodies.push_back(&simulation.add(shape, 1, btVector3(btScalar(0.05 * i), 0, btScalar(0.1 + 0.2 * i))));
  simulation.run(1);
  std::vector<btScalar> places;
  for (const btRigidBody* body : bodies) {
    const btVector3& place = body->getWorldTransform().getOrigin();
    places.insert(places.end(), {place.x(), place.y(), place.z()});
  }
  for (btRigidBody* body : bodies) simulation.world.removeRigidBody(body);
  return places;
}

TEST(Recipes, DispatchersMoveBodiesAlike) {
  RecipeWorld<> plain;
  PackingCollisionAlgorithm::registerAlgorithm(&plain.dispatcher);
  RecipeWorld<innersphere::BatchedDispatcher<>> batched;
  btSetTaskScheduler(btGetSequentialTaskScheduler());  // btCollisionDispatcherMt needs one when it is made
  RecipeWorld<innersphere::BatchedDispatcher<btCollisionDispatcherMt>> threaded;
  PackingCollisionAlgorithm::registerAlgorithm(&batched.dispatcher);
  PackingCollisionAlgorithm::registerAlgorithm(&threaded.dispatcher);
  {
    btDefaultCollisionConfiguration configuration;
    // [snippet batched dispatcher]
    innersphere::BatchedDispatcher<> dispatcher(&configuration);  // in place of a btCollisionDispatcher
    innersphere::PackingCollisionAlgorithm::registerAlgorithm(&dispatcher);
    // [snippet]
    EXPECT_TRUE(PackingCollisionAlgorithm::isRegistered(&dispatcher));
    // [snippet end of a world]
    innersphere::PackingCollisionAlgorithm::unregisterAlgorithm(&dispatcher);  // before it is destroyed
    // [snippet]
    EXPECT_FALSE(PackingCollisionAlgorithm::isRegistered(&dispatcher));
  }
  const std::vector<btScalar> places = heapOf(plain);
  EXPECT_EQ(places, heapOf(batched));
  EXPECT_EQ(places, heapOf(threaded));
  EXPECT_GT(places[5], places[2]);  // they do lie on each other
}

TEST(Recipes, TheLogTellsOfAWorldThatWasForgotten) {
  std::vector<std::string> messages;
  // [snippet log]
  innersphere::setLogCallback([&](const std::string& message) { messages.push_back(message); });
  // [snippet]
  PackingShape shape(torusModel());
  btBoxShape box(btVector3(1, 1, 1));
  RecipeWorld<> forgotten;
  forgotten.add(shape, 0, btVector3(0, 0, 3));
  forgotten.add(box, 1, btVector3(0, 0, 5));
  EXPECT_FALSE(PackingCollisionAlgorithm::isRegistered(&forgotten.dispatcher));
  forgotten.run(1);
  innersphere::setLogCallback(nullptr);
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_NE(messages[0].find("registerAlgorithm"), std::string::npos) << messages[0];
}

}  // namespace
}  // namespace innersphere::recipes
