// Kinds of bodies: static, kinematic, links of multi-bodies, children of compounds, bodies with joints.
#include <gtest/gtest.h>

#include <algorithm>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "recipes/recipe_world.hpp"

namespace innersphere::recipes {
namespace {

const btQuaternion kUpright = btQuaternion::getIdentity();

TEST(Recipes, AStaticPackingCarriesABody) {
  RecipeWorld<> simulation;
  btDiscreteDynamicsWorld& world = simulation.world;
  PackingCollisionAlgorithm::registerAlgorithm(&simulation.dispatcher);
  const std::shared_ptr<const CollisionModel> model = boxModel({1, 1, 0.2});
  const btTransform mesh_pose(kUpright, btVector3(0, 0, btScalar(0.5)));
  // [snippet static]
  innersphere::PackingShape shape(model, innersphere::PackingShape::Frame::mesh);
  btRigidBody table(0, nullptr, &shape);  // mass 0: it does not move
  table.setWorldTransform(mesh_pose);
  world.addRigidBody(&table);
  // [snippet]
  PackingShape torus(torusModel());
  const btRigidBody& on_top = simulation.add(torus, 1, btVector3(0, 0, btScalar(0.7)));
  simulation.run(2);
  EXPECT_NEAR(on_top.getWorldTransform().getOrigin().z(), 0.6 + kTubeRadius, 0.001);
  world.removeRigidBody(&table);
}

TEST(Recipes, AFastBodyStopsAtAThinWall) {
  RecipeWorld<> simulation;
  btDiscreteDynamicsWorld& world = simulation.world;
  PackingCollisionAlgorithm::registerAlgorithm(&simulation.dispatcher);
  world.setGravity(btVector3(0, 0, 0));
  btBoxShape box(btVector3(btScalar(0.025), 2, 2));
  simulation.add(box, 0, btVector3(0, 0, 3));
  PackingShape torus(torusModel());
  btRigidBody& body = simulation.add(torus, 1, btVector3(-2, 0, 3));
  const btVector3 velocity(100, 0, 0);
  // [snippet fast]
  body.setCcdMotionThreshold(btScalar(0.05));  // [m] in a step: faster, it is swept
  body.setLinearVelocity(velocity);
  // [snippet]
  for (int step = 0; step < 20; ++step) world.stepSimulation(btScalar(1) / 60, 0);
  EXPECT_LT(body.getWorldTransform().getOrigin().x(), 0);
}

TEST(Recipes, AKinematicPackingLiftsABody) {
  RecipeWorld<> simulation;
  btDiscreteDynamicsWorld& world = simulation.world;
  PackingCollisionAlgorithm::registerAlgorithm(&simulation.dispatcher);
  PackingShape shape(boxModel({1, 1, 0.2}), PackingShape::Frame::mesh);
  btTransform mesh_pose(kUpright, btVector3(0, 0, btScalar(0.5)));
  const btScalar dt = btScalar(1) / 240;
  // [snippet kinematic]
  btDefaultMotionState motion(mesh_pose);  // a shape in the frame of the mesh
  btRigidBody lift(0, &motion, &shape);
  lift.setCollisionFlags(lift.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  lift.setActivationState(DISABLE_DEACTIVATION);
  world.addRigidBody(&lift);
  // before each step: Bullet takes the place, and the speed, from the motion state
  mesh_pose.getOrigin() += btVector3(0, 0, btScalar(0.5)) * dt;
  motion.m_graphicsWorldTrans = mesh_pose;
  // [snippet]
  PackingShape torus(torusModel());
  const btRigidBody& on_top = simulation.add(torus, 1, btVector3(0, 0, btScalar(0.6 + kTubeRadius)));
  for (int step = 0; step < 240; ++step) {
    mesh_pose.getOrigin() += btVector3(0, 0, btScalar(0.5)) * dt;
    motion.m_graphicsWorldTrans = mesh_pose;
    world.stepSimulation(dt, 0);
  }
  EXPECT_NEAR(on_top.getWorldTransform().getOrigin().z(), mesh_pose.getOrigin().z() + 0.1 + kTubeRadius,
              0.003);
  EXPECT_NEAR(on_top.getLinearVelocity().z(), 0.5, 0.02);
  world.removeRigidBody(&lift);
}

TEST(Recipes, ALinkOfAMultiBodyRestsOnTheFloor) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btMultiBodyConstraintSolver solver;
  btMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity(btVector3(0, 0, btScalar(-9.81)));
  btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  btRigidBody floor(0, nullptr, &plane);
  world.addRigidBody(&floor);
  PackingCollisionAlgorithm::registerAlgorithm(&dispatcher);
  const std::shared_ptr<const CollisionModel> model = bracketModel();
  const PackingShape upright(model);
  const btTransform link_from_mesh(kUpright, upright.meshToBody().getOrigin());
  const btScalar mass = 1;
  const btVector3 inertia(1, 1, 1);
  btMultiBody body(1, 0, btVector3(0, 0, 0), true, false);
  body.setBaseWorldTransform(btTransform(kUpright, btVector3(0, 0, 1)));
  // A rail along which the link may fall.
  body.setupPrismatic(0, mass, inertia, -1, kUpright, btVector3(0, 0, 1), btVector3(0, 0, 0),
                      btVector3(0, 0, 0), true);
  body.finalizeMultiDof();
  const int link = 0;
  // [snippet multi-body]
  innersphere::PackingShape shape(model, link_from_mesh);  // where the mesh is in the link's frame
  btMultiBodyLinkCollider collider(&body, link);
  collider.setCollisionShape(&shape);
  body.getLink(link).m_collider = &collider;
  world.addCollisionObject(&collider, btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::AllFilter);
  world.addMultiBody(&body);
  // [snippet]
  for (int step = 0; step < 480; ++step) world.stepSimulation(btScalar(1) / 240, 0);
  // It stands on the lowest point of the mesh.
  float lowest = 1e9f;
  for (const auto& vertex : model->packing().surface.vertices) lowest = std::min(lowest, vertex[2]);
  EXPECT_NEAR(shape.meshTransform(collider.getWorldTransform()).getOrigin().z(), -lowest, 0.001);
  world.removeMultiBody(&body);
  world.removeCollisionObject(&collider);
  world.removeRigidBody(&floor);
  PackingCollisionAlgorithm::unregisterAlgorithm(&dispatcher);
}

TEST(Recipes, ACompoundOfPackingsRests) {
  RecipeWorld<> simulation;
  btDiscreteDynamicsWorld& world = simulation.world;
  PackingCollisionAlgorithm::registerAlgorithm(&simulation.dispatcher);
  PackingShape torus(torusModel());
  btBoxShape box(btVector3(btScalar(0.05), btScalar(0.05), btScalar(0.2)));
  const btTransform torus_pose(kUpright, btVector3(0, 0, 0));
  const btTransform box_pose(kUpright, btVector3(0, 0, btScalar(0.28)));
  btScalar masses[] = {3, 1};
  // [snippet compound]
  btCompoundShape compound;
  compound.addChildShape(torus.bodyTransform(torus_pose), &torus);
  compound.addChildShape(box_pose, &box);

  btTransform principal;  // where the whole has its principal frame
  btVector3 inertia;
  compound.calculatePrincipalAxisTransform(masses, principal, inertia);
  for (int i = 0; i < compound.getNumChildShapes(); ++i)
    compound.updateChildTransform(i, principal.inverse() * compound.getChildTransform(i));
  // [snippet]
  btDefaultMotionState motion(btTransform(kUpright, btVector3(0, 0, btScalar(0.1))), principal.inverse());
  btRigidBody body(4, &motion, &compound, inertia);
  world.addRigidBody(&body);
  simulation.run(2);
  EXPECT_NEAR(motion.m_graphicsWorldTrans.getOrigin().z(), kTubeRadius, 0.001);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), kTubeRadius + 0.28 / 4, 0.001);
  world.removeRigidBody(&body);
}

TEST(Recipes, AJointHoldsAPointOfTheMesh) {
  RecipeWorld<> simulation;
  btDiscreteDynamicsWorld& world = simulation.world;
  PackingCollisionAlgorithm::registerAlgorithm(&simulation.dispatcher);
  PackingShape shape(bracketModel());
  btRigidBody& body = simulation.add(shape, 1, btVector3(0, 0, 3));
  const btVector3 hole(btScalar(0.1), btScalar(0.2), btScalar(0.05));
  const btVector3 before = shape.meshTransform(body.getWorldTransform()) * hole;
  // [snippet pivot]
  btPoint2PointConstraint joint(body, shape.meshToBody() * hole);  // a point of the mesh
  world.addConstraint(&joint);
  // [snippet]
  simulation.run(1);
  EXPECT_LT((shape.meshTransform(body.getWorldTransform()) * hole - before).length(), 0.01);
  EXPECT_GT(body.getAngularVelocity().length() + (body.getWorldTransform().getOrigin() - before).length(),
            0.1);
  world.removeConstraint(&joint);
}

}  // namespace
}  // namespace innersphere::recipes
