// A world of Bullet's own shapes with a SubstepSolver.
#pragma once

#include <memory>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "innersphere/substep_solver.hpp"

namespace innersphere::test {

constexpr btScalar kGravity = btScalar(9.81);  // [m/s^2]

class SolverWorld {
 public:
  explicit SolverWorld(const SubstepOptions& options = {}) : solver(options) {
    world.setGravity(btVector3(0, 0, -kGravity));
    world.getDispatchInfo().m_deterministicOverlappingPairs = true;
  }
  ~SolverWorld() {
    for (const auto& constraint : constraints) world.removeConstraint(constraint.get());
    for (const auto& body : bodies) world.removeRigidBody(body.get());
  }

  /// Mass 0: it stands still. The inertia is that of the shape, or as it is given.
  btRigidBody& add(std::unique_ptr<btCollisionShape> shape, btScalar mass, const btVector3& position,
                   btVector3 inertia = btVector3(0, 0, 0)) {
    if (mass > 0 && inertia.isZero()) shape->calculateLocalInertia(mass, inertia);
    auto body = std::make_unique<btRigidBody>(mass, nullptr, shape.get(), inertia);
    body->setWorldTransform(btTransform(btQuaternion::getIdentity(), position));
    body->setActivationState(DISABLE_DEACTIVATION);
    shapes.push_back(std::move(shape));
    world.addRigidBody(body.get());
    return *bodies.emplace_back(std::move(body));
  }
  btRigidBody& addBox(const btVector3& half, btScalar mass, const btVector3& position) {
    return add(std::make_unique<btBoxShape>(half), mass, position);
  }
  btRigidBody& addBall(btScalar radius, btScalar mass, const btVector3& position) {
    return add(std::make_unique<btSphereShape>(radius), mass, position);
  }
  btRigidBody& addFloor() {
    return add(std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0)), 0, btVector3(0, 0, 0));
  }
  /// Between boxes Bullet finds all points at once, on its plane one more in each step.
  btRigidBody& addSlab() { return addBox(btVector3(50, 50, 1), 0, btVector3(0, 0, -1)); }
  template <class Constraint, typename... Arguments>
  Constraint& join(Arguments&&... arguments) {
    auto made = std::make_unique<Constraint>(std::forward<Arguments>(arguments)...);
    Constraint& constraint = *made;
    constraints.push_back(std::move(made));
    world.addConstraint(&constraint, true);
    return constraint;
  }

  void step(btScalar dt = btScalar(1) / 60) { world.stepSimulation(dt, 0); }
  void run(double seconds, double dt = 1.0 / 60) {
    for (int i = 0; i < static_cast<int>(seconds / dt + 0.5); ++i) step(btScalar(dt));
  }
  /// [J]
  double energy() const {
    double sum = 0;
    for (const auto& body : bodies) {
      if (body->isStaticObject()) continue;
      const btVector3 spin = body->getAngularVelocity() * body->getWorldTransform().getBasis();
      const btVector3 inverse = body->getInvInertiaDiagLocal();
      sum += body->getMass() *
             (body->getLinearVelocity().length2() / 2 + kGravity * body->getWorldTransform().getOrigin().z());
      for (int k = 0; k < 3; ++k) sum += inverse[k] > 0 ? spin[k] * spin[k] / inverse[k] / 2 : 0;
    }
    return sum;
  }
  std::vector<btScalar> motion() const {
    std::vector<btScalar> all;
    for (const auto& body : bodies) {
      for (const btVector3& v : {body->getWorldTransform().getOrigin(), body->getLinearVelocity(),
                                 body->getAngularVelocity(), body->getWorldTransform().getBasis()[0]})
        all.insert(all.end(), {v.x(), v.y(), v.z()});
    }
    return all;
  }

  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  SubstepSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  std::vector<std::unique_ptr<btTypedConstraint>> constraints;
};

/// Boxes that lie in layers, and a chain of hinges over them.
inline void fill(SolverWorld& world, int across, int layers) {
  world.addFloor();
  for (int z = 0; z < layers; ++z) {
    for (int x = 0; x < across; ++x) {
      for (int y = 0; y < across; ++y) {
        const btScalar shift = btScalar(0.1) * btScalar(z % 2);
        world.addBox(btVector3(0.2f, 0.2f, 0.2f), 1,
                     btVector3(btScalar(0.41) * btScalar(x) + shift, btScalar(0.41) * btScalar(y) + shift,
                               btScalar(0.2) + btScalar(0.4) * btScalar(z)));
      }
    }
  }
  btRigidBody* above = nullptr;
  for (int i = 0; i < 8; ++i) {
    btRigidBody& link =
        world.addBox(btVector3(0.1f, 0.05f, 0.05f), 1, btVector3(btScalar(0.2) * btScalar(i), 0, 9));
    if (above != nullptr)
      world.join<btHingeConstraint>(*above, link, btVector3(0.1f, 0, 0), btVector3(-0.1f, 0, 0),
                                    btVector3(0, 1, 0), btVector3(0, 1, 0));
    above = &link;
  }
}

}  // namespace innersphere::test
