// A Bullet world with a floor for bodies to fall on.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "innersphere/packing_collision_algorithm.hpp"

namespace innersphere::test {

/// Debian's Bullet is built without threads: there the multithreaded dispatcher works, in its own order and
/// with its own release of manifolds, but on one thread.
enum class DispatcherKind { plain, multithreaded, batched, batched_multithreaded };
/// For names of tests.
std::string nameOf(DispatcherKind kind);
std::string nameOf(Response response);

using MakeDispatcher = std::function<std::unique_ptr<btCollisionDispatcher>(btCollisionConfiguration*)>;
/// Of a test's own class.
template <class Dispatcher>
std::unique_ptr<btCollisionDispatcher> make(btCollisionConfiguration* configuration) {
  return std::make_unique<Dispatcher>(configuration);
}

class TestWorld {
 public:
  explicit TestWorld(const ContactOptions& options = {}, DispatcherKind kind = DispatcherKind::plain);
  TestWorld(const ContactOptions& options, const MakeDispatcher& make);
  ~TestWorld();

  /// A body of mass 0 is static. The shape is kept alive by the world.
  btRigidBody& add(std::shared_ptr<btCollisionShape> shape, double mass, const btVector3& position,
                   const btQuaternion& rotation = btQuaternion::getIdentity());
  btRigidBody& addFloor();  ///< the plane z = 0

  void run(double seconds, double dt = 1.0 / 60);

  double kineticEnergy() const;
  int contactCount() const;
  /// Where all bodies are and how they move, to compare worlds bit by bit.
  std::vector<btScalar> motion() const;
  double deepestContact() const;  ///< [m], positive
  /// Of the body that was added last, deepest first; normals point to it.
  std::vector<btManifoldPoint> contactsOfLast() const;

  btDefaultCollisionConfiguration configuration;
  const std::unique_ptr<btCollisionDispatcher> owned_dispatcher;
  btCollisionDispatcher& dispatcher;
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world;
  std::vector<std::unique_ptr<btRigidBody>> bodies;

 private:
  std::vector<std::shared_ptr<btCollisionShape>> shapes_;
};

/// Angle between a body's axis that is nearest to the vertical and the vertical [degrees].
double tiltDegrees(const btRigidBody& body);

}  // namespace innersphere::test
