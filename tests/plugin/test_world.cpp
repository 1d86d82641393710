#include "test_world.hpp"

#include <algorithm>
#include <cmath>

#include <BulletCollision/CollisionDispatch/btCollisionDispatcherMt.h>
#include <LinearMath/btThreads.h>

#include "innersphere/batched_dispatcher.hpp"

namespace innersphere::test {

namespace {

MakeDispatcher maker(DispatcherKind kind) {
  switch (kind) {
    case DispatcherKind::multithreaded:
      return make<btCollisionDispatcherMt>;
    case DispatcherKind::batched:
      return make<BatchedDispatcher<>>;
    case DispatcherKind::batched_multithreaded:
      return make<BatchedDispatcher<btCollisionDispatcherMt>>;
    default:
      return make<btCollisionDispatcher>;
  }
}

std::unique_ptr<btCollisionDispatcher> dispatcherOf(const MakeDispatcher& make,
                                                    btCollisionConfiguration* configuration) {
  btSetTaskScheduler(btGetSequentialTaskScheduler());  // btCollisionDispatcherMt asks for it when it is made
  return make(configuration);
}

}  // namespace

std::string nameOf(DispatcherKind kind) {
  constexpr const char* kNames[] = {"plain", "Mt", "Batched", "BatchedMt"};
  return kNames[static_cast<int>(kind)];
}

std::string nameOf(Response response) {
  constexpr const char* kNames[] = {"Compliant", "Rigid", "Penalty"};
  return kNames[static_cast<int>(response)];
}

TestWorld::TestWorld(const ContactOptions& options, DispatcherKind kind) : TestWorld(options, maker(kind)) {}

TestWorld::TestWorld(const ContactOptions& options, const MakeDispatcher& make)
    : owned_dispatcher(dispatcherOf(make, &configuration)),
      dispatcher(*owned_dispatcher),
      world(&dispatcher, &broadphase, &solver, &configuration) {
  PackingCollisionAlgorithm::registerAlgorithm(&dispatcher, options);
  world.setGravity(btVector3(0, 0, btScalar(-9.81)));
}

TestWorld::~TestWorld() {
  for (const auto& body : bodies) world.removeRigidBody(body.get());
}

btRigidBody& TestWorld::add(std::shared_ptr<btCollisionShape> shape, double mass, const btVector3& position,
                            const btQuaternion& rotation) {
  btVector3 inertia(0, 0, 0);
  if (mass > 0) shape->calculateLocalInertia(btScalar(mass), inertia);
  btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, shape.get(), inertia);
  info.m_startWorldTransform = btTransform(rotation, position);
  bodies.push_back(std::make_unique<btRigidBody>(info));
  world.addRigidBody(bodies.back().get());
  shapes_.push_back(std::move(shape));
  return *bodies.back();
}

btRigidBody& TestWorld::addFloor() {
  return add(std::make_shared<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0)), 0, btVector3(0, 0, 0));
}

void TestWorld::run(double seconds, double dt) {
  const int steps = static_cast<int>(std::lround(seconds / dt));
  for (int i = 0; i < steps; ++i) world.stepSimulation(btScalar(dt), 0);
}

double TestWorld::kineticEnergy() const {
  double energy = 0;
  for (const auto& body : bodies) {
    if (body->isStaticObject()) continue;
    const btVector3 spin = body->getAngularVelocity();
    const btVector3 momentum = body->getInvInertiaTensorWorld().inverse() * spin;
    energy += 0.5 * (body->getLinearVelocity().length2() / body->getInvMass() + momentum.dot(spin));
  }
  return energy;
}

int TestWorld::contactCount() const {
  int count = 0;
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    count += dispatcher.getManifoldByIndexInternal(i)->getNumContacts();
  }
  return count;
}

std::vector<btScalar> TestWorld::motion() const {
  std::vector<btScalar> all;
  for (const auto& body : bodies) {
    const btQuaternion turn = body->getWorldTransform().getRotation();
    for (const btVector3& v :
         {body->getWorldTransform().getOrigin(), body->getLinearVelocity(), body->getAngularVelocity()})
      all.insert(all.end(), {v.x(), v.y(), v.z()});
    all.insert(all.end(), {turn.x(), turn.y(), turn.z(), turn.w()});
  }
  return all;
}

double TestWorld::deepestContact() const {
  double deepest = 0;
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
      deepest = std::max(deepest, -double(manifold.getContactPoint(k).getDistance()));
    }
  }
  return deepest;
}

std::vector<btManifoldPoint> TestWorld::contactsOfLast() const {
  std::vector<btManifoldPoint> points;
  for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(m);
    const bool last_is_a = manifold.getBody0() == bodies.back().get();
    for (int i = 0; i < manifold.getNumContacts(); ++i) {
      points.push_back(manifold.getContactPoint(i));
      if (!last_is_a) points.back().m_normalWorldOnB *= -1;
    }
  }
  std::sort(points.begin(), points.end(),
            [](const auto& p, const auto& q) { return p.getDistance() < q.getDistance(); });
  return points;
}

double tiltDegrees(const btRigidBody& body) {
  double cosine = 0;
  for (int axis = 0; axis < 3; ++axis) {
    cosine = std::max(cosine, std::fabs(double(body.getWorldTransform().getBasis()[2][axis])));
  }
  return std::acos(std::min(1.0, cosine)) * 180 / M_PI;
}

}  // namespace innersphere::test
