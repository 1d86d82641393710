// The smallest program: a packed solid drops onto a plane in an otherwise ordinary Bullet world.
//   innersphere pack torus --spheres 1000 -o torus.cbor && hello_bullet torus.cbor
// With an installed InnerSphere and no build system:
//   c++ -std=c++17 -O2 hello_bullet.cpp $(pkg-config --cflags --libs innersphere) -o hello_bullet
#include <algorithm>
#include <cstdio>

#include "innersphere/error.hpp"
#include "innersphere/substep_solver.hpp"

// [snippet use]
#include <memory>

#include <btBulletDynamicsCommon.h>

#include "innersphere/packing_collision_algorithm.hpp"
#include "innersphere/packing_file.hpp"
#include "innersphere/packing_shape.hpp"
// [snippet]

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s PACKING\n", argv[0]);
    return 2;
  }
  const char* file = argv[1];

  // An existing Bullet program has this already. With btSequentialImpulseConstraintSolver, step by 1/240 s.
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  innersphere::SubstepSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  btRigidBody floor(0, nullptr, &plane);
  world.setGravity(btVector3(0, 0, -9.81f));
  world.addRigidBody(&floor);

  // [snippet use]
  innersphere::PackingCollisionAlgorithm::prepareWorld(world);  // once: registers, sets 2 friction directions

  auto packing = std::make_shared<innersphere::Packing>(innersphere::readPacking(file));
  auto model = std::make_shared<innersphere::CollisionModel>(packing);
  innersphere::PackingShape shape(model);  // bodies of the same solid share it

  btScalar mass = 1;  // [kg]
  btVector3 inertia;
  shape.calculateLocalInertia(mass, inertia);
  btTransform mesh_pose(btQuaternion::getIdentity(), btVector3(0, 0, 2));  // where the mesh is to be
  btDefaultMotionState motion(mesh_pose, shape.meshToBody());              // the body has another frame
  btRigidBody body(mass, &motion, &shape, inertia);
  world.addRigidBody(&body);
  // after a step: draw the mesh at motion.m_graphicsWorldTrans
  // [snippet]

  for (int step = 0; step < 5 * 60; ++step) world.stepSimulation(btScalar(1) / 60, 0);

  // Bullet's box around a body that is turned is larger than the body. An .xyzr file has no surface.
  const btTransform packing_pose = body.getWorldTransform() * shape.principalTransform();
  btScalar lowest = BT_LARGE_FLOAT;
  for (const auto& v : packing->surface.vertices)
    lowest = std::min(lowest, packing_pose(btVector3(v[0], v[1], v[2])).z());
  for (const auto& s : packing->spheres)
    lowest = std::min(lowest, packing_pose(btVector3(s.x, s.y, s.z)).z() - s.radius);
  std::printf("after 5 s: centre at %.4f m, lowest point at %.4f m, speed %.4f m/s\n",
              double(body.getWorldTransform().getOrigin().z()), double(lowest),
              double(body.getLinearVelocity().length()));
  const bool rests = body.getLinearVelocity().length() < 0.05 && lowest > -0.05;
  world.removeRigidBody(&body);
  world.removeRigidBody(&floor);
  return rests ? 0 : 1;
} catch (const innersphere::Error& error) {
  std::fprintf(stderr, "%s: %s\n", toString(error.code()), error.what());
  return 3;
}
