// Packings on links of multi-bodies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "common/body_velocity.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr btScalar kStep = btScalar(1) / 60;
const btQuaternion kUpright = btQuaternion::getIdentity();

std::shared_ptr<PackingShape> cube() {
  return makeShape(latticeBox({1, 1, 1}, 6));
}

class MultiBodyWorld {
 public:
  explicit MultiBodyWorld(const ContactOptions& options = {})
      : dispatcher_(&configuration_), world_(&dispatcher_, &broadphase_, &solver_, &configuration_) {
    PackingCollisionAlgorithm::registerAlgorithm(&dispatcher_, options);
    setGravity(10);
  }
  ~MultiBodyWorld() {
    for (const auto& body : multi_bodies_) world_.removeMultiBody(body.get());
    for (const auto& collider : colliders_) world_.removeCollisionObject(collider.get());
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }

  btRigidBody& add(std::shared_ptr<btCollisionShape> shape, double mass, const btVector3& position) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(btScalar(mass), inertia);
    bodies_.push_back(std::make_unique<btRigidBody>(btScalar(mass), nullptr, shape.get(), inertia));
    bodies_.back()->setWorldTransform(btTransform(kUpright, position));
    world_.addRigidBody(bodies_.back().get());
    shapes_.push_back(std::move(shape));
    return *bodies_.back();
  }
  btRigidBody& addFloor() {
    return add(std::make_shared<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0)), 0, btVector3(0, 0, 0));
  }

  /// Of unit cubes; its joints, and then collide(), are up to the caller.
  btMultiBody& addMultiBody(int links, bool fixed, const btVector3& base) {
    multi_bodies_.push_back(std::make_unique<btMultiBody>(links, 1, inertia(), fixed, false));
    multi_bodies_.back()->setBaseWorldTransform(btTransform(kUpright, base));
    multi_bodies_.back()->setLinearDamping(0);
    multi_bodies_.back()->setAngularDamping(0);
    return *multi_bodies_.back();
  }
  btMultiBodyLinkCollider& collide(btMultiBody& body, int link, std::shared_ptr<btCollisionShape> shape) {
    colliders_.push_back(std::make_unique<btMultiBodyLinkCollider>(&body, link));
    btMultiBodyLinkCollider& collider = *colliders_.back();
    collider.setCollisionShape(shape.get());
    if (link < 0) {
      body.setBaseCollider(&collider);
    } else {
      body.getLink(link).m_collider = &collider;
    }
    shapes_.push_back(std::move(shape));
    return collider;
  }
  void start(btMultiBody& body) {
    body.finalizeMultiDof();
    btAlignedObjectArray<btQuaternion> rotations;
    btAlignedObjectArray<btVector3> places;
    body.forwardKinematics(rotations, places);
    body.updateCollisionObjectWorldTransforms(rotations, places);
    for (const auto& collider : colliders_) {
      if (collider->m_multiBody == &body)
        world_.addCollisionObject(collider.get(), btBroadphaseProxy::DefaultFilter,
                                  btBroadphaseProxy::AllFilter);
    }
    world_.addMultiBody(&body);
  }

  /// A cube that is free to fall.
  btMultiBodyLinkCollider& addBase(const btVector3& position) {
    btMultiBody& body = addMultiBody(0, false, position);
    btMultiBodyLinkCollider& collider = collide(body, -1, cube());
    start(body);
    return collider;
  }
  /// The same on a vertical rail that hangs from nothing.
  btMultiBodyLinkCollider& addOnRail(const btVector3& position) {
    btMultiBody& body = addMultiBody(1, true, position);
    body.setupPrismatic(0, 1, inertia(), -1, kUpright, btVector3(0, 0, 1), btVector3(0, 0, 0),
                        btVector3(0, 0, 0), true);
    btMultiBodyLinkCollider& collider = collide(body, 0, cube());
    start(body);
    return collider;
  }
  /// Two cubes side by side, joined by a hinge along y at the middle of their common edge at the bottom.
  void addHinged(const btVector3& base, btMultiBodyLinkCollider*& first, btMultiBodyLinkCollider*& second) {
    const btScalar half = btScalar(0.5);
    btMultiBody& body = addMultiBody(1, false, base);
    body.setupRevolute(0, 1, inertia(), -1, kUpright, btVector3(0, 1, 0), btVector3(half, 0, -half),
                       btVector3(half, 0, half), true);
    first = &collide(body, -1, cube());
    second = &collide(body, 0, cube());
    start(body);
  }

  void setGravity(double down) { world_.setGravity(btVector3(0, 0, btScalar(-down))); }
  void run(double seconds) {
    for (int i = 0; i < seconds * 60; ++i) world_.stepSimulation(kStep, 0);
  }

  static btVector3 inertia() { return btVector3(1, 1, 1) / 6; }

 private:
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btMultiBodyConstraintSolver solver_;
  btMultiBodyDynamicsWorld world_;
  std::vector<std::shared_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btMultiBody>> multi_bodies_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
};

double heightOf(const btCollisionObject& object) {
  return object.getWorldTransform().getOrigin().z();
}

/// Of a link's points, by the Jacobian that Bullet's solver uses.
btVector3 velocityByJacobian(btMultiBody& body, int link, const btVector3& point) {
  btAlignedObjectArray<btScalar> scalars;
  btAlignedObjectArray<btVector3> vectors;
  btAlignedObjectArray<btMatrix3x3> matrices;
  std::vector<btScalar> row(std::size_t(6 + body.getNumDofs()));
  btVector3 velocity(0, 0, 0);
  for (int axis = 0; axis < 3; ++axis) {
    btVector3 direction(0, 0, 0);
    direction[axis] = 1;
    body.fillContactJacobianMultiDof(link, point, direction, row.data(), scalars, vectors, matrices);
    for (std::size_t i = 0; i < row.size(); ++i) velocity[axis] += row[i] * body.getVelocityVector()[i];
  }
  return velocity;
}

TEST(MultiBody, VelocityOfALinkIsThatOfItsJacobian) {
  MultiBodyWorld world;
  btMultiBody& body = world.addMultiBody(3, false, btVector3(1, 2, 3));
  const btVector3 inertia = MultiBodyWorld::inertia();
  const btQuaternion turned(btVector3(1, 2, 3).normalized(), btScalar(0.7));
  body.setupRevolute(0, 1, inertia, -1, turned, btVector3(0, 1, 0), btVector3(1, 0, 0), btVector3(1, 1, 0));
  body.setupPrismatic(1, 1, inertia, 0, turned, btVector3(0, 0, 1), btVector3(0, 1, 0), btVector3(0, 0, 1),
                      true);
  body.setupSpherical(2, 1, inertia, 1, turned, btVector3(0, 0, 1), btVector3(1, 0, 0));
  body.setWorldToBaseRot(btQuaternion(btVector3(0, 1, 1).normalized(), 1));
  btMultiBodyLinkCollider* colliders[4];
  for (int link = -1; link < 3; ++link) colliders[link + 1] = &world.collide(body, link, cube());
  body.finalizeMultiDof();
  body.setJointPos(0, btScalar(0.4));
  body.setJointPos(1, btScalar(0.3));
  body.setBaseVel(btVector3(1, -2, 3));
  body.setBaseOmega(btVector3(btScalar(0.5), 1, -1));
  body.setJointVel(0, 2);
  body.setJointVel(1, -1);
  const btScalar spin[3] = {1, -2, btScalar(0.5)};
  body.setJointVelMultiDof(2, spin);
  world.start(body);
  for (int link = -1; link < 3; ++link) {
    const BodyVelocity velocity(*colliders[link + 1]);
    const btVector3 origin = colliders[link + 1]->getWorldTransform().getOrigin();
    for (const btVector3& arm : {btVector3(0, 0, 0), btVector3(1, 0, 0), btVector3(0, 1, -1)}) {
      const btVector3 difference =
          velocity.linear + velocity.spin.cross(arm) - velocityByJacobian(body, link, origin + arm);
      EXPECT_LT(difference.length(), 1e-5) << link;
    }
  }
}

TEST(MultiBody, ABaseRestsOnAPlane) {
  MultiBodyWorld world;
  world.addFloor();
  const btCollisionObject& base = world.addBase(btVector3(0, 0, btScalar(0.6)));
  world.run(2);
  EXPECT_NEAR(heightOf(base), 0.5, 0.005);
}

TEST(MultiBody, HingedLinksRestOnPlanesAndPackings) {
  for (const bool on_packing : {false, true}) {
    MultiBodyWorld world;
    if (on_packing) {
      world.add(makeShape(latticeBox({4, 4, 2}, 12)), 0, btVector3(0, 0, -1));
    } else {
      world.addFloor();
    }
    btMultiBodyLinkCollider *first = nullptr, *second = nullptr;
    world.addHinged(btVector3(btScalar(-0.5), 0, btScalar(0.6)), first, second);
    world.run(2);
    EXPECT_NEAR(heightOf(*first), 0.5, 0.005) << on_packing;
    EXPECT_NEAR(heightOf(*second), 0.5, 0.005) << on_packing;
  }
}

/// Its solver does not split impulses: what drives the bodies apart stays with them as speed.
TEST(MultiBody, LinksThatStartInsideAPackingPartGently) {
  for (const double depth : {0.05, 0.2, 0.45}) {
    MultiBodyWorld world;
    world.add(makeShape(latticeBox({4, 4, 2}, 12)), 0, btVector3(0, 0, -1));
    btMultiBodyLinkCollider *first = nullptr, *second = nullptr;
    world.addHinged(btVector3(btScalar(-0.5), 0, btScalar(0.5 - depth)), first, second);
    double highest = 0;
    for (int i = 0; i < 120; ++i) {
      world.run(kStep);
      highest = std::max({highest, heightOf(*first), heightOf(*second)});
    }
    EXPECT_LT(highest, 0.55) << depth;
    EXPECT_NEAR(heightOf(*first), 0.5, 0.005) << depth;
    EXPECT_NEAR(heightOf(*second), 0.5, 0.005) << depth;
  }
}

/// As rigid bodies do: at the speed of the fall times the restitution.
TEST(MultiBody, BasesAndLinksReboundAsTheirRestitutionSays) {
  constexpr double kSpeed = 4, kRestitution = 0.8;
  for (const bool on_rail : {false, true}) {
    MultiBodyWorld world;
    world.setGravity(0);
    world.addFloor().setRestitution(1);
    const btVector3 start(0, 0, btScalar(1.02));
    btMultiBodyLinkCollider& body = on_rail ? world.addOnRail(start) : world.addBase(start);
    body.setRestitution(btScalar(kRestitution));
    if (on_rail) {
      body.m_multiBody->setJointVel(0, -kSpeed);
    } else {
      body.m_multiBody->setBaseVel(btVector3(0, 0, -kSpeed));
    }
    world.run(0.5);
    const double before = heightOf(body);
    world.run(0.1);
    EXPECT_NEAR((heightOf(body) - before) / 0.1, kSpeed * kRestitution, 0.01) << on_rail;
  }
}

TEST(MultiBody, AFastLinkDoesNotGoIntoAPlate) {
  MultiBodyWorld world;
  world.add(makeShape(latticeBox({3, 3, btScalar(0.1)}, 6)), 0, btVector3(0, 0, 0));
  btMultiBodyLinkCollider& link = world.addOnRail(btVector3(0, 0, btScalar(1.3)));
  link.m_multiBody->setJointVel(0, -20);  // a third of its size in a step
  double lowest = 1;
  for (int i = 0; i < 30; ++i) {
    world.run(kStep);
    lowest = std::min(lowest, heightOf(link));
  }
  EXPECT_GT(lowest, 0.54);
  EXPECT_NEAR(heightOf(link), 0.55, 0.01);
}

TEST(MultiBody, PenaltyResponseIsCompliantForLinks) {
  const auto fall = [](Response response, double stiffness) {
    ContactOptions options;
    options.response = response;
    options.stiffness = stiffness;
    MultiBodyWorld world(options);
    world.addFloor();
    const btCollisionObject& base = world.addBase(btVector3(0, 0, btScalar(0.6)));
    world.run(1);
    EXPECT_NEAR(heightOf(base), 0.5, 0.005);
    return base.getWorldTransform().getOrigin();
  };
  EXPECT_EQ(fall(Response::penalty, 1e6), fall(Response::compliant, 1e6));
  fall(Response::penalty, 0);
}

}  // namespace
}  // namespace innersphere::test
