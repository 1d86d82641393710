// What the recipes of the user's guide start from: an ordinary Bullet program.
#pragma once

#include <memory>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "innersphere/packing_collision_algorithm.hpp"
#include "innersphere/packing_shape.hpp"

namespace innersphere::recipes {

/// A world with gravity and a floor at z = 0. `Dispatcher` is the class that a recipe shows.
template <class Dispatcher = btCollisionDispatcher>
class RecipeWorld {
 public:
  RecipeWorld() {
    world.setGravity(btVector3(0, 0, btScalar(-9.81)));
    world.getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
    add(plane_, 0, btVector3(0, 0, 0));
  }
  ~RecipeWorld() {
    for (int i = world.getNumConstraints() - 1; i >= 0; --i) world.removeConstraint(world.getConstraint(i));
    for (int i = world.getNumCollisionObjects() - 1; i >= 0; --i)
      world.removeCollisionObject(world.getCollisionObjectArray()[i]);
    PackingCollisionAlgorithm::unregisterAlgorithm(&dispatcher);
  }

  /// A body of mass 0 is static.
  btRigidBody& add(btCollisionShape& shape, btScalar mass, const btVector3& place) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape.calculateLocalInertia(mass, inertia);
    bodies_.push_back(std::make_unique<btRigidBody>(mass, nullptr, &shape, inertia));
    bodies_.back()->setWorldTransform(btTransform(btQuaternion::getIdentity(), place));
    world.addRigidBody(bodies_.back().get());
    return *bodies_.back();
  }
  void run(double seconds) {
    for (int step = 0; step < seconds * 240; ++step) world.stepSimulation(btScalar(1) / 240, 0);
  }

  btDefaultCollisionConfiguration configuration;
  Dispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};

 private:
  btStaticPlaneShape plane_{btVector3(0, 0, 1), 0};
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

constexpr double kTubeRadius = 0.08;  ///< of the torus [m]: how high its centre is when it lies flat

/// Of a torus about the z axis; packed once for all tests.
std::shared_ptr<const CollisionModel> torusModel();

/// Of an L, whose own frame is not the principal one.
std::shared_ptr<const CollisionModel> bracketModel();

/// Of a box with these edges. Its overlap errors take most of the time of packing it.
std::shared_ptr<const CollisionModel> boxModel(const Vec3d& size, bool overlap_errors = false);

}  // namespace innersphere::recipes
