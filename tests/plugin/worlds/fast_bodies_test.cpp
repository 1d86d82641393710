// Fast packings with the motion threshold of Bullet's continuous collision detection: no wall is too thin.
#include <gtest/gtest.h>
#include <cmath>

#include "innersphere/solids.hpp"
#include "innersphere/substep_solver.hpp"
#include "named_packings.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kThickness = 0.05;
constexpr double kStep = 1.0 / 60;

std::shared_ptr<PackingShape> torus() {
  static const std::shared_ptr<PackingShape> shape = makeTorusShape(0.35, 0.15, 256);
  return shape;
}

/// Both faces of a wall across z.
std::shared_ptr<btCollisionShape> meshWall() {
  static btTriangleMesh triangles;
  if (triangles.getNumTriangles() == 0) {
    for (const btScalar z : {btScalar(kThickness / 2), btScalar(-kThickness / 2)}) {
      const btVector3 a(-z * 160, -4, z), b(z * 160, -4, z), c(z * 160, 4, z), d(-z * 160, 4, z);
      triangles.addTriangle(a, b, c);
      triangles.addTriangle(a, c, d);
    }
  }
  return std::make_shared<btBvhTriangleMeshShape>(&triangles, true);
}

/// A wall across z, with its middle at the origin.
std::shared_ptr<btCollisionShape> makeWall(const std::string& name) {
  if (name == "plane")
    return std::make_shared<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(kThickness / 2));
  if (name == "mesh") return meshWall();
  if (name == "packing") {
    static const std::shared_ptr<PackingShape> wall = makePackedShape(*makeBox({3, 3, kThickness}), 4000);
    return wall;
  }
  return std::make_shared<btBoxShape>(btVector3(4, 4, btScalar(kThickness / 2)));
}

/// The torus, or another body, on its way to a wall.
struct Throw {
  Throw(const std::string& wall_name, double speed, double tilt, double start) {
    world.world.setGravity(btVector3(0, 0, 0));
    wall = &world.add(makeWall(wall_name), 0, btVector3(0, 0, 0));
    const btQuaternion turn(btVector3(1, 0, 0), btScalar(tilt * M_PI / 180));
    body = &world.add(torus(), 1, btVector3(0, 0, btScalar(start)), turn);
    body->setLinearVelocity(btVector3(0, 0, btScalar(-speed)));
    duration = start / speed + 0.2;
  }
  /// Returns the least z of its centre, and notes the most energy that it had.
  double run() {
    double lowest = BT_LARGE_FLOAT;
    const double before = world.kineticEnergy();
    for (int i = 0; i < std::lround(duration / kStep); ++i) {
      world.world.stepSimulation(btScalar(kStep), 0);
      lowest = std::min(lowest, double(body->getWorldTransform().getOrigin().z()));
      gain = std::max(gain, world.kineticEnergy() / before - 1);
    }
    return lowest;
  }

  TestWorld world;
  btRigidBody* wall;
  btRigidBody* body;
  double duration;
  double gain = -1;
};

class FastBodies : public testing::TestWithParam<std::tuple<std::string, double>> {};

TEST_P(FastBodies, AreThroughAtNoSpeed) {
  const auto& [wall, tilt] = GetParam();
  for (const double speed : {5.0, 20.0, 50.0, 100.0}) {
    for (int i = 0; i < 10; ++i) {
      Throw thrown(wall, speed, tilt, 1 + 0.1 * i * speed * kStep);
      thrown.body->setCcdMotionThreshold(btScalar(0.05));
      EXPECT_GT(thrown.run(), 0) << speed << " m/s, start " << i;
      EXPECT_LT(thrown.gain, 1e-3) << speed << " m/s, start " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Walls, FastBodies,
                         testing::Combine(testing::Values("box", "plane", "mesh", "packing"),
                                          testing::Values(0.0, 20.0, 45.0, 70.0, 90.0)),
                         [](const auto& info) {
                           return std::get<0>(info.param) + "_" +
                                  std::to_string(std::lround(std::get<1>(info.param))) + "_degrees";
                         });

TEST(FastBodies, FlatOnAWallTheyStopAtItsFace) {
  for (const char* wall : {"box", "plane", "mesh", "packing"}) {
    for (const double speed : {20.0, 50.0, 100.0}) {
      Throw thrown(wall, speed, 0, 1 + 0.35 * speed * kStep);
      thrown.body->setCcdMotionThreshold(btScalar(0.05));
      EXPECT_GT(thrown.run(), 0.15) << wall << ' ' << speed << ": no deeper than to the middle of the wall";
    }
  }
}

// From rest, by a force that drives it as far as its size within a step: no velocity tells of that.
TEST(FastBodies, WhatIsPressedOnAWallStaysBeforeIt) {
  constexpr double kGap = 0.002, kForce = 600;
  SubstepSolver solver;
  for (const bool substeps : {false, true}) {
    for (const char* wall : {"plane", "box", "packing"}) {
      TestWorld world;
      if (substeps) world.world.setConstraintSolver(&solver);
      PackingCollisionAlgorithm::prepareWorld(world.world);
      world.world.setGravity(btVector3(0, 0, 0));
      world.add(makeWall(wall), 0, btVector3(0, 0, 0));
      btRigidBody& body = world.add(torus(), 1, btVector3(0, 0, btScalar(kThickness / 2 + 0.15 + kGap)));
      for (int i = 0; i < 30; ++i) {
        body.applyCentralForce(btVector3(0, 0, btScalar(-kForce)));
        world.run(kStep, kStep);
      }
      EXPECT_GT(body.getWorldTransform().getOrigin().z(), 0.15) << wall << ", " << substeps;
    }
  }
}

TEST(FastBodies, WithoutTheThresholdSomeAreThrough) {
  int through = 0;
  for (int i = 0; i < 10; ++i) through += Throw("box", 100, 0, 1 + 0.1 * i * 100 * kStep).run() < -1;
  EXPECT_GT(through, 0) << "else the tests here show nothing";
}

// A beam flat over a floor, without the threshold. Contact is foretold further than its lower corners are
// apart across it.
TEST(FastBodies, LandOnAllCorners) {
  const double half = 0.1, length = 1;
  for (const double gap : {0.15, 0.4}) {
    TestWorld world;
    world.addFloor();
    btRigidBody& beam = world.add(makeShape(latticeBox({length, 2 * half, 2 * half}, 4)), 1,
                                  btVector3(0, 0, btScalar(half + gap)));
    beam.setLinearVelocity(btVector3(0, 0, btScalar(-1.2 * gap / kStep)));
    world.run(kStep, kStep);
    EXPECT_EQ(world.contactCount(), 4) << gap;
    EXPECT_NEAR(beam.getWorldTransform().getOrigin().z(), half, 0.01) << gap;
    EXPECT_LT(beam.getAngularVelocity().length(), 0.1) << gap;
  }
}

TEST(FastBodies, BelowTheThresholdNothingIsDifferent) {
  for (const char* wall : {"box", "packing"}) {
    Throw plain(wall, 5, 20, 1), flagged(wall, 5, 20, 1);
    flagged.body->setCcdMotionThreshold(btScalar(5 * kStep * 1.5));
    flagged.body->setCcdSweptSphereRadius(btScalar(0.1));
    plain.run();
    flagged.run();
    EXPECT_EQ(plain.world.motion(), flagged.world.motion()) << wall;
  }
}

TEST(FastBodies, BounceAsFastAsTheyCame) {
  for (const double speed : {20.0, 100.0}) {
    Throw thrown("box", speed, 0, 1.3);
    thrown.body->setCcdMotionThreshold(btScalar(0.05));
    thrown.body->setRestitution(1);
    thrown.wall->setRestitution(1);
    EXPECT_GT(thrown.run(), 0);
    EXPECT_NEAR(thrown.body->getLinearVelocity().z(), speed, 0.02 * speed);
  }
}

TEST(FastBodies, MeetEachOther) {
  for (const double speed : {5.0, 20.0, 50.0, 100.0}) {
    for (int i = 0; i < 10; ++i) {
      TestWorld world;
      world.world.setGravity(btVector3(0, 0, 0));
      const btScalar start = btScalar(0.6 + 0.1 * i * 2 * speed * kStep);
      btRigidBody& upper = world.add(torus(), 1, btVector3(0, 0, start));
      btRigidBody& lower =
          world.add(torus(), 2, btVector3(0, 0, -start), btQuaternion(btVector3(0, 1, 0), 0.3f));
      upper.setCcdMotionThreshold(btScalar(0.05));  // one of them is enough
      upper.setLinearVelocity(btVector3(0, 0, btScalar(-speed)));
      lower.setLinearVelocity(btVector3(0, 0, btScalar(speed)));
      const auto momentum = [&] { return upper.getLinearVelocity() + lower.getLinearVelocity() * 2; };
      const btVector3 before = momentum();
      for (int s = 0; s < std::lround((start / speed + 0.2) / kStep); ++s) {
        world.world.stepSimulation(btScalar(kStep), 0);
        // Once they have met they turn about each other, at a hundredth of their speed, until either may be
        // the upper one. What goes through is fast.
        const btScalar apart =
            upper.getWorldTransform().getOrigin().z() - lower.getWorldTransform().getOrigin().z();
        const btScalar approach = lower.getLinearVelocity().z() - upper.getLinearVelocity().z();
        ASSERT_TRUE(apart > 0 || approach < btScalar(0.1 * speed)) << speed << " m/s, start " << i;
      }
      EXPECT_LT((momentum() - before).length(), 1e-4 * 3 * speed);
    }
  }
}

/// Floor and two walls of one mesh: a body that slides along the one meets the other in the same step.
TEST(FastBodies, DoNotLeaveTheCornerOfARoom) {
  btTriangleMesh triangles;
  const auto addQuad = [&](const btVector3& a, const btVector3& b, const btVector3& c, const btVector3& d) {
    triangles.addTriangle(a, b, c);
    triangles.addTriangle(a, c, d);
  };
  addQuad({-20, -20, 0}, {0, -20, 0}, {0, 0, 0}, {-20, 0, 0});
  addQuad({0, -20, 0}, {0, -20, 4}, {0, 0, 4}, {0, 0, 0});
  addQuad({-20, 0, 0}, {0, 0, 0}, {0, 0, 4}, {-20, 0, 4});
  for (const double speed : {20.0, 50.0, 100.0}) {
    for (int i = -4; i <= 4; ++i) {
      TestWorld world;
      btRigidBody& room =
          world.add(std::make_shared<btBvhTriangleMeshShape>(&triangles, true), 0, btVector3(0, 0, 0));
      btRigidBody& body = world.add(torus(), 1, btVector3(btScalar(-3 - 0.2 * i), -3, btScalar(0.15)));
      room.setFriction(0);
      body.setCcdMotionThreshold(btScalar(0.05));
      body.setLinearVelocity(btVector3(1, 1, 0).normalized() * btScalar(speed));
      for (int s = 0; s < std::lround((5 / speed + 0.2) / kStep); ++s) {
        world.world.stepSimulation(btScalar(kStep), 0);
        const btVector3& at = body.getWorldTransform().getOrigin();
        ASSERT_LT(std::max(at.x(), at.y()), 0) << speed << " m/s, start " << i;
        ASSERT_GT(at.z(), 0) << speed << " m/s, start " << i;
      }
    }
  }
}

}  // namespace
}  // namespace innersphere::test
