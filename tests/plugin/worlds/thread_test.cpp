// A nut on its bolt touches nowhere but on its flanks, and there as deep as the helix says, at any turn.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "innersphere/solids.hpp"
#include "innersphere/substep_solver.hpp"
#include "named_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

// Of the named solids.
constexpr double kPitch = 0.125, kClearance = 0.01, kDepth = 0.068;  // [m]
/// Along the axis, of a flank a metre wide.
constexpr double kSlope = kPitch / 3 / kDepth;

struct Found : btCollisionWorld::ContactResultCallback {
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    const double depth = -double(point.getDistance());
    if (depth > deepest) {
      deepest = depth;
      upwards = std::fabs(double(point.m_normalWorldOnB.z()));
    }
    return 0;
  }
  double deepest = -1;
  double upwards = 0;  ///< of the normal there
};

std::shared_ptr<PackingShape> named(const char* name) {
  return makePackedShape(*makeNamedSolid(name), 1000);
}

/// What the meshes overlap by beyond the helicoids, at most: points on the vertices, edges and faces of
/// either, in some of the places below, are 0.3 to 0.6 mm deeper in the other. Curved normals take most of
/// that away.
constexpr double kFacets = 6e-4;

TEST(Thread, TouchesAsTheHelixSays) {
  int places = 0, off = 0;
  const double flank = 1 / std::sqrt(1 + kSlope * kSlope);
  const auto bolt_shape = named("bolt"), nut_shape = named("nut");
  TestWorld world;
  btRigidBody& bolt = world.add(bolt_shape, 0, btVector3(0, 0, 0));
  bolt.setWorldTransform(bolt_shape->principalTransform().inverse());
  btRigidBody& nut = world.add(nut_shape, 1, btVector3(0, 0, 0));
  // A 72nd of a turn is half a step of the mesh.
  for (int step = 0; step < 240; ++step) {
    const double angle = 2 * M_PI * 0.2 * step / 72;
    // From where the flanks touch, if the clearance is taken up on one side.
    for (const double lowered : {-0.0005, 0.0002, 0.0005}) {
      SCOPED_TRACE("step " + std::to_string(step) + ", lowered by " + std::to_string(lowered));
      const double height = 0.475 + kPitch * angle / (2 * M_PI) - kClearance * kSlope - lowered;
      const btTransform place(btQuaternion(btVector3(0, 0, 1), btScalar(2 * M_PI * 0.475 / kPitch + angle)),
                              btVector3(0, 0, btScalar(height)));
      nut.setWorldTransform(place * nut_shape->principalTransform().inverse());
      world.world.updateAabbs();
      Found found;
      found.m_closestDistanceThreshold = btScalar(0.002);
      world.world.contactPairTest(&nut, &bolt, found);
      if (lowered < 0) {
        EXPECT_LT(found.deepest, 0);
        continue;
      }
      const double beyond = found.deepest - lowered * flank;
      EXPECT_GT(beyond, -1e-4);
      EXPECT_LT(beyond, kFacets);
      ++places;
      off += beyond > 1e-4;
      EXPECT_NEAR(found.upwards, flank, 0.02);
    }
  }
  EXPECT_LE(off, places / 100);
}

// With friction 0.0025 a nut turns at 0.96 of the rate that it has without: one of 35 mm turned at 0.04 of it
// at 60 steps/s, as it was braked like what rocks on one place, which it touches all around.
TEST(Thread, TurnsASmallNutWithSubsteps) {
  constexpr double kScale = 0.04, kSmallPitch = kScale * kPitch, kGravity = 9.81, kStep = 1.0 / 60;
  const auto bolt_shape = named("bolt"), nut_shape = named("nut");
  for (const auto& shape : {bolt_shape, nut_shape})
    shape->setLocalScaling(btVector3(btScalar(kScale), btScalar(kScale), btScalar(kScale)));
  TestWorld world;
  SubstepSolver solver;
  world.world.setConstraintSolver(&solver);
  PackingCollisionAlgorithm::prepareWorld(world.world);
  btRigidBody& bolt = world.add(bolt_shape, 0, btVector3(0, 0, 0));
  bolt.setWorldTransform(bolt_shape->bodyTransform(btTransform::getIdentity()));
  btRigidBody& nut = world.add(nut_shape, 0.05, btVector3(0, 0, 0));
  nut.setCenterOfMassTransform(nut_shape->bodyTransform(
      btTransform(btQuaternion::getIdentity(), btVector3(0, 0, btScalar(3 * kSmallPitch)))));
  for (btRigidBody* body : {&bolt, &nut}) body->setFriction(btScalar(0.05));
  world.run(0.15, kStep);
  nut.setLinearVelocity(btVector3(0, 0, 0));
  nut.setAngularVelocity(btVector3(0, 0, 0));
  const btMatrix3x3 inertia = nut.getInvInertiaTensorWorld().inverse();
  const double gyration2 = inertia[2][2] * nut.getInvMass(), turns = 2 * M_PI / kSmallPitch;
  const double falls = kGravity / (1 + turns * turns * gyration2);
  constexpr double kSeconds = 0.5;
  world.run(kSeconds, kStep);
  EXPECT_NEAR(std::fabs(nut.getAngularVelocity().z()) / (falls * kSeconds * turns), 0.96, 0.04);
  world.world.setConstraintSolver(&world.solver);
}

}  // namespace
}  // namespace innersphere::test
