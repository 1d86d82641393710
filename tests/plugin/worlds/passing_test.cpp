// Bodies that pass each other do not touch, however near: what goes past a ledge falls freely, and what
// slides from one tile of a floor to the next is not held up by its side.
#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "each_world.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/solids.hpp"
#include "innersphere/substep_solver.hpp"
#include "named_packings.hpp"
#include "outline_meshes.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr btScalar kTile = 1, kCube = btScalar(0.6);  // [m] edges
constexpr btScalar kGravity = btScalar(9.81);

std::shared_ptr<btCollisionShape> cube(bool packing, btScalar edge) {
  const btVector3 half(edge / 2, edge / 2, edge / 2);
  if (!packing) return std::make_shared<btBoxShape>(half);
  return makePackedShape(*makeBox({double(edge), double(edge), double(edge)}), 256);
}

struct Case {
  bool substeps, ground, body;  // which are packings
  double rate, beside;          // [m]
};

std::string nameOf(const testing::TestParamInfo<Case>& info) {
  const Case& c = info.param;
  return std::string(c.substeps ? "Substeps" : "Bullet") + (c.body ? "Packing" : "Box") + "On" +
         (c.ground ? "Packing" : "Box") + std::to_string(int(c.rate)) + "By" +
         std::to_string(int(std::lround(1e4 * c.beside)));
}

struct World : TestWorld {
  explicit World(bool substeps) {
    if (substeps) world.setConstraintSolver(&substep_solver);
    PackingCollisionAlgorithm::prepareWorld(world);
  }
  ~World() { world.setConstraintSolver(&solver); }
  SubstepSolver substep_solver;
};

class Passing : public testing::TestWithParam<Case> {};

TEST_P(Passing, ACubeFallsFreelyBesideALedge) {
  const Case& c = GetParam();
  World world(c.substeps);
  world.add(cube(c.ground, kTile), 0, btVector3(0, 0, -kTile / 2));
  const btScalar beside = (kTile + kCube) / 2 + btScalar(c.beside);
  btRigidBody& body = world.add(cube(c.body, kCube), 1, btVector3(beside, btScalar(0.13), kCube / 2 + 1));
  const double seconds = 0.6;
  world.run(seconds, 1 / c.rate);
  ASSERT_LT(body.getWorldTransform().getOrigin().z(), 0);
  EXPECT_NEAR(body.getLinearVelocity().z(), -kGravity * seconds, 0.001);
  EXPECT_LT(body.getAngularVelocity().length(), 0.001);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().x(), beside, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(
    Ledge, Passing,
    testing::Values(Case{true, false, true, 60, 0.0005}, Case{false, false, true, 60, 0.02},
                    Case{true, false, true, 240, 0.004}, Case{false, false, true, 240, 0.0005},
                    Case{true, true, false, 60, 0.004}, Case{false, true, false, 120, 0.002},
                    Case{true, true, true, 60, 0.01}, Case{false, true, true, 240, 0.002}),
    nameOf);

// The post is straight where the ring's tube bends: its normals are those of what is near.
TEST(PassingRing, FallsFreelyAroundAPost) {
  constexpr double kPost = 0.05, kTube = 0.015, kFalls = 0.25;
  const auto post =
      makePackedShape(*makeSolid(turnedMesh({{0, 0}, {kPost, 0}, {kPost, 0.5}, {0, 0.5}}), "post"), 256);
  for (const double gap : {0.004, 0.01, 0.02}) {
    const auto ring = makeTorusShape(kPost + gap + kTube, kTube, 256);
    inEachWorld([&](TestWorld& world, bool substeps, double rate) {
      const btTransform stands = post->bodyTransform(btTransform::getIdentity());
      btRigidBody& fixed = world.add(post, 0, stands.getOrigin(), stands.getRotation());
      btRigidBody& body = world.add(ring, 0.01, btVector3(0, btScalar(0.7 * gap), btScalar(0.42)));
      fixed.setFriction(0);
      body.setFriction(0);
      world.run(kFalls, 1 / rate);
      EXPECT_NEAR(body.getLinearVelocity().z(), -kGravity * kFalls, 0.001)
          << gap << " m, " << (substeps ? "substeps, " : "") << rate << " steps/s";
      EXPECT_LT(body.getAngularVelocity().length(), 0.001);
    });
  }
}

class Tiles : public testing::TestWithParam<Case> {};

TEST_P(Tiles, HoldNothingUp) {
  const Case& c = GetParam();
  World world(c.substeps);
  const btScalar lower = btScalar(c.beside);
  world.add(cube(c.ground, kTile), 0, btVector3(0, 0, -kTile / 2)).setFriction(0);
  world.add(cube(c.ground, kTile), 0, btVector3(kTile, 0, -kTile / 2 - lower)).setFriction(0);
  btRigidBody& body = world.add(cube(c.body, kCube), 1, btVector3(0, btScalar(0.13), kCube / 2));
  body.setFriction(0);
  body.setActivationState(DISABLE_DEACTIVATION);
  world.run(0.3, 1 / c.rate);
  const btScalar speed = 4;
  body.setLinearVelocity(btVector3(speed, 0, 0));
  world.run(1.1 * kTile / speed, 1 / c.rate);
  EXPECT_NEAR(body.getLinearVelocity().x(), speed, 0.01 * speed);
  EXPECT_LT(body.getWorldTransform().getOrigin().z(), kCube / 2 + btScalar(0.001));
}

INSTANTIATE_TEST_SUITE_P(Floor, Tiles,
                         testing::Values(Case{true, false, true, 60, 0}, Case{false, false, true, 60, 0.002},
                                         Case{true, false, true, 240, 0.002},
                                         Case{false, false, true, 240, 0}, Case{true, true, false, 60, 0.002},
                                         Case{false, true, true, 120, 0}, Case{true, true, true, 240, 0},
                                         Case{false, true, true, 60, 0.01}),
                         nameOf);

/// What bounces off a ledge still does: as far on it as a body's depth at rest, it is held.
TEST(Passing, ACubeIsHeldByTheEdgeOfALedge) {
  for (const bool substeps : {false, true}) {
    for (const double rate : {60.0, 240.0}) {
      World world(substeps);
      world.add(cube(false, kTile), 0, btVector3(0, 0, -kTile / 2));
      const btScalar over = btScalar(0.01);
      btRigidBody& body =
          world.add(cube(true, kCube), 1, btVector3((kTile + kCube) / 2 - over, 0, kCube / 2 + 1));
      world.run(0.6, 1 / rate);
      EXPECT_GT(body.getAngularVelocity().y(), 1) << substeps << rate;  // it tips off
    }
  }
}

/// The far side of a hole is no wall for what slides over it: flat faces, and such that bend hollow.
TEST(Passing, ABoxSlidesOverAHole) {
  constexpr double kHole = 0.08, kThick = 0.1, kHalf = 0.05, kSpeed = 1.2;
  const auto box = makePackedShape(*makeBox({0.3, 0.3, 2 * kHalf}), 256);
  for (const int sides : {4, 8, 16}) {
    const Mesh mesh = ringMesh({{kHole, -kThick}, {1, -kThick}, {1, 0}, {kHole, 0}}, std::uint32_t(sides));
    const auto plate = makePackedShape(*makeSolid(mesh, "plate"), 256);
    for (const bool substeps : {false, true}) {
      for (const double rate : {60.0, 240.0}) {
        World world(substeps);
        world.add(plate, 0, plate->bodyTransform(btTransform::getIdentity()).getOrigin()).setFriction(0);
        btRigidBody& body = world.add(box, 1, btVector3(btScalar(-0.5), btScalar(0.003), btScalar(kHalf)));
        body.setFriction(0);
        body.setLinearVelocity(btVector3(btScalar(kSpeed), 0, 0));
        world.run(1 / kSpeed, 1 / rate);
        EXPECT_NEAR(body.getLinearVelocity().x(), kSpeed, 0.01 * kSpeed) << sides << substeps << rate;
        EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), kHalf, 0.001) << sides << substeps << rate;
      }
    }
  }
}

/// Nor is the next slab behind a gap, for a ring with a round bore on packings, and a box on Bullet's boxes,
/// which lie deeper than a thousandth of their size at 60 steps/s.
TEST(Passing, ABodySlidesOverAGap) {
  constexpr btScalar kGap = btScalar(0.08), kHalf = btScalar(0.05), kSpeed = btScalar(1.2);
  const btVector3 slab(1, 1, kHalf);
  const Mesh bored = ringMesh({{0.08, -0.05}, {0.15, -0.05}, {0.15, 0.05}, {0.08, 0.05}}, 6);
  const auto ring = makePackedShape(*makeSolid(bored, "ring"), 256);
  const auto box = makePackedShape(*makeBox({0.3, 0.3, 0.1}), 256);
  const auto packed_slab = makePackedShape(*makeBox({2, 2, 0.1}), 256);
  for (const bool on_packing : {false, true}) {
    const std::shared_ptr<btCollisionShape> ground =
        on_packing ? std::shared_ptr<btCollisionShape>(packed_slab) : std::make_shared<btBoxShape>(slab);
    for (const bool substeps : {false, true}) {
      for (const double rate : {60.0, 240.0}) {
        World world(substeps);
        for (const int side : {-1, 1})
          world.add(ground, 0, btVector3(btScalar(side) * (1 + kGap / 2), 0, -kHalf)).setFriction(0);
        btRigidBody& body = world.add(on_packing ? ring : box, 1, btVector3(btScalar(-0.3), 0, kHalf));
        body.setFriction(0);
        body.setLinearVelocity(btVector3(kSpeed, 0, 0));
        world.run(0.5, 1 / rate);
        EXPECT_NEAR(body.getLinearVelocity().x(), kSpeed, 0.01 * kSpeed) << on_packing << substeps << rate;
      }
    }
  }
}

/// A tower on a plate tips where the plate speeds up by g b / h, with b half of its width and h half of its
/// height. It rocks before it stands, as the speed begins at once, and slides by a hair. It walked off and
/// tipped where its corners passed for what glides along beside an edge.
TEST(Passing, ATowerThatRocksStandsOnItsCorners) {
  constexpr btScalar kHalf = btScalar(0.1), kHeight = btScalar(0.3), kPlate = 1;
  const auto tower = makePackedShape(*makeBox({2 * kHalf, 2 * kHalf, 2 * kHeight}), 256);
  const auto plate = makePackedShape(*makeBox({2 * kPlate, 2 * kPlate, 2 * kHalf}), 256);
  for (const int rate : {60, 120, 240}) {
    for (const double part : {0.9, 0.95, 1.05}) {
      World world(true);
      btRigidBody& moved = world.add(plate, 0, btVector3(0, 0, -kHalf));
      moved.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
      moved.setActivationState(DISABLE_DEACTIVATION);
      btRigidBody& body = world.add(tower, 1, btVector3(0, 0, kHeight));
      body.setActivationState(DISABLE_DEACTIVATION);
      for (btRigidBody* b : {&moved, &body}) b->setFriction(btScalar(1.2));
      world.run(0.5, 1.0 / rate);
      const double acceleration = part * kGravity * kHalf / kHeight;
      btScalar x = 0;
      for (int i = 1; i <= 2 * rate; ++i) {
        x = btScalar(acceleration / 2 * i * i / rate / rate);
        moved.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(x, 0, -kHalf)));
        world.run(1.0 / rate, 1.0 / rate);
      }
      const bool tips = body.getWorldTransform().getBasis()[2].z() < 0.99;
      EXPECT_EQ(tips, part > 1) << rate << " steps/s, " << part;
      if (tips) continue;
      EXPECT_NEAR(body.getWorldTransform().getOrigin().x(), x, 0.001) << rate << " steps/s, " << part;
    }
  }
}

}  // namespace
}  // namespace innersphere::test
