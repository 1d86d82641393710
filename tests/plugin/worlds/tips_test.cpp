// What stands on the sharp tips of cones bears there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "innersphere/mesh.hpp"
#include "innersphere/substep_solver.hpp"
#include "named_packings.hpp"
#include "outline_meshes.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

/// A disc on a stem that ends in a cone of 27 degrees.
std::shared_ptr<PackingShape> top() {
  return makePackedShape(*makeSolid(turnedMesh({{0, 0},
                                                {0.03, 0.06},
                                                {0.03, 0.2},
                                                {0.2, 0.22},
                                                {0.2, 0.27},
                                                {0.03, 0.29},
                                                {0.03, 0.35},
                                                {0, 0.35}}),
                                    "top"),
                         256);
}

// Friction at a point has no torque about it, so a fast top keeps its energy and, about its axis, its spin.
TEST(Tips, OfATopKeepItsSpin) {
  constexpr double kSpin = 60, kSeconds = 2;
  const auto shape = top();
  for (const double rate : {60.0, 240.0}) {
    TestWorld world;
    SubstepSolver solver;
    world.world.setConstraintSolver(&solver);
    PackingCollisionAlgorithm::prepareWorld(world.world);
    world.addFloor().setFriction(1);
    const btTransform place =
        shape->bodyTransform(btTransform(btQuaternion(btVector3(0, 1, 0), btScalar(0.2))));
    btRigidBody& body = world.add(shape, 2, place.getOrigin(), place.getRotation());
    body.setFriction(1);
    const auto mesh = [&] { return body.getWorldTransform() * shape->meshToBody(); };
    const auto axis = [&] { return mesh().getBasis() * btVector3(0, 0, 1); };
    body.setAngularVelocity(axis() * btScalar(kSpin));
    const double before = world.kineticEnergy();
    world.run(kSeconds, 1 / rate);
    EXPECT_GT(world.kineticEnergy(), 0.98 * before) << rate;
    EXPECT_NEAR(body.getAngularVelocity().dot(axis()), kSpin, 0.01 * kSpin) << rate;
    EXPECT_LT(mesh().getOrigin().length(), 0.01) << rate;  // of the tip
    world.world.setConstraintSolver(&world.solver);
  }
}

TEST(Tips, AreWhereConesTouch) {
  constexpr double kDeep = 0.0005;
  const auto shape = top();
  TestWorld world;
  btRigidBody& floor = world.addFloor();
  btRigidBody& body = world.add(shape, 1, btVector3(0, 0, 0));
  struct Deepest : btCollisionWorld::ContactResultCallback {
    btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                             const btCollisionObjectWrapper*, int, int) override {
      if (-point.getDistance() > depth) place = point.getPositionWorldOnB();
      depth = std::max(depth, -double(point.getDistance()));
      return 0;
    }
    double depth = -1;
    btVector3 place{0, 0, 0};
  };
  std::mt19937 random(1);
  std::uniform_real_distribution<double> part(-1, 1);
  for (int i = 0; i < 200; ++i) {
    const btQuaternion turn = btQuaternion(btVector3(0, 0, 1), btScalar(M_PI * part(random))) *
                              btQuaternion(btVector3(0, 1, 0), btScalar(0.6 * part(random))) *
                              btQuaternion(btVector3(0, 0, 1), btScalar(M_PI * part(random)));
    const btVector3 tip(btScalar(part(random)), btScalar(part(random)), btScalar(-kDeep));
    body.setWorldTransform(shape->bodyTransform(btTransform(turn, tip)));
    Deepest found;
    world.world.contactPairTest(&floor, &body, found);
    EXPECT_NEAR(found.depth, kDeep, 1e-5) << i;
    EXPECT_LT(std::hypot(found.place.x() - tip.x(), found.place.y() - tip.y()), 1e-4) << i;
  }
}

}  // namespace
}  // namespace innersphere::test
