// What a user can read, and see, of the contacts of a step.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include <LinearMath/btIDebugDraw.h>

#include "innersphere/contact_drawer.hpp"
#include "innersphere/error.hpp"
#include "innersphere/pair_overlaps.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kGravity = 9.81;
constexpr int kCells = 8;
constexpr double kRadius = 0.5 / kCells;

/// Volume that a plane cuts from the lattice cube at a depth below the radius of its balls.
double cutVolume(double depth) {
  return kCells * kCells * M_PI * depth * depth * (3 * kRadius - depth) / 3;
}

TEST(PairOverlaps, ForceOfARestingBodyIsItsWeight) {
  for (const Response response : {Response::compliant, Response::rigid, Response::penalty}) {
    ContactOptions options;
    options.response = response;
    options.estimator = Estimator::raw;
    TestWorld world(options);
    btRigidBody& floor = world.addFloor();
    btRigidBody& cube =
        world.add(makeShape(latticeBox({1, 1, 1}, kCells)), 2, btVector3(3, 0, btScalar(0.5)));
    cube.setActivationState(DISABLE_DEACTIVATION);
    world.run(3, 1.0 / 240);
    const auto pairs = pairOverlaps(&world.dispatcher);
    ASSERT_EQ(pairs.size(), 1u);
    const PairOverlap& pair = pairs[0];
    EXPECT_EQ(pair.a, &cube);
    EXPECT_EQ(pair.b, &floor);
    EXPECT_NEAR(pair.force.z(), -2 * kGravity, 0.02 * 2 * kGravity);
    EXPECT_NEAR(pair.force.x(), 0, 0.1);
    EXPECT_NEAR(pair.centroid.x(), 3, 0.02);
    const btVector3 arm = pair.centroid - cube.getWorldTransform().getOrigin();
    EXPECT_NEAR((pair.torque + arm.cross(pair.force)).length(), 0, 0.02 * 2 * kGravity * 0.5);
  }
}

TEST(PairOverlaps, VolumeIsThatOfThePlacesInTheStep) {
  for (const Response response : {Response::compliant, Response::penalty}) {
    for (const double depth : {0.01, 0.04}) {
      ContactOptions options;
      options.response = response;
      options.estimator = Estimator::raw;
      TestWorld world(options);
      world.world.setGravity(btVector3(0, 0, 0));
      world.addFloor();
      world.add(makeShape(latticeBox({1, 1, 1}, kCells)), 1, btVector3(0, 0, btScalar(0.5 - depth)));
      world.run(1.0 / 60);
      const auto pairs = pairOverlaps(&world.dispatcher);
      ASSERT_EQ(pairs.size(), 1u);
      EXPECT_NEAR(pairs[0].volume, cutVolume(depth), 1e-3 * cutVolume(depth));
      if (response == Response::compliant) {
        EXPECT_NEAR(pairs[0].depth, depth, 1e-4);
      }
      EXPECT_NEAR(pairs[0].area.z(), -kCells * kCells * M_PI * depth * (2 * kRadius - depth), 1e-3);
    }
  }
}

TEST(PairOverlaps, TwoPackingsAgreeOnTheirForce) {
  ContactOptions options;
  options.response = Response::penalty;
  options.stiffness = 1e5;
  options.damping = 0;
  options.estimator = Estimator::raw;
  TestWorld world(options);
  world.world.setGravity(btVector3(0, 0, 0));
  const auto shape = makeShape(singleBall(0.5));
  btRigidBody& a = world.add(shape, 1, btVector3(0, 0, 0));
  world.add(shape, 1, btVector3(0, 0, btScalar(0.9)));
  world.run(1e-3, 1e-3);
  const auto pairs = pairOverlaps(&world.dispatcher);
  ASSERT_EQ(pairs.size(), 1u);
  // Two caps of height 0.05.
  const double volume = 2 * M_PI * 0.05 * 0.05 * (1.5 - 0.05) / 3;
  EXPECT_NEAR(pairs[0].volume, volume, 1e-4 * volume);
  const double force = 1e5 * volume * (pairs[0].a == &a ? 1 : -1);
  EXPECT_NEAR(pairs[0].penalty_force.z(), force, 1e-3 * std::fabs(force));
  EXPECT_NEAR(a.getLinearVelocity().z(), -1e-3 * std::fabs(force), 1e-3);
  EXPECT_GT(pairs[0].penalty_energy, 0);
}

// A ball that bounces on the spring of its overlap: below the reported step its energy stays, beyond it the
// energy grows. For a push through the centre the report is on the safe side by sqrt(1 + 5/2).
TEST(PairOverlaps, LargestStepIsStableAndNotFarFromTheTruth) {
  const auto fastestAt = [](double factor) {
    ContactOptions options;
    options.response = Response::penalty;
    options.stiffness = 1e5;
    options.damping = 0;
    TestWorld world(options);
    world.addFloor();
    btRigidBody& ball = world.add(makeShape(singleBall(0.5)), 1, btVector3(0, 0, btScalar(0.49)));
    ball.setActivationState(DISABLE_DEACTIVATION);
    world.run(1e-5, 1e-5);
    const double step = factor * pairOverlaps(&world.dispatcher).at(0).largest_step;
    double fastest = 0;
    for (int i = 0; i < 1000; ++i) {
      world.run(step, step);
      fastest = std::max(fastest, double(ball.getLinearVelocity().length()));
    }
    return fastest;
  };
  EXPECT_LT(fastestAt(0.9), 0.6);
  EXPECT_GT(fastestAt(3), 2 * fastestAt(0.9));
}

TEST(PairOverlaps, ChildrenOfACompoundArePairsOfTheirOwn) {
  constexpr double kDepth = 0.03, kMass = 2, kStep = 1.0 / 60;
  ContactOptions options;
  options.estimator = Estimator::raw;
  TestWorld world(options);
  world.world.setGravity(btVector3(0, 0, 0));
  btRigidBody& floor = world.addFloor();
  const auto child = makeShape(latticeBox({1, 1, 1}, kCells));
  auto compound = std::make_shared<btCompoundShape>();
  for (const btScalar x : {-1, 1})
    compound->addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(x, 0, 0)), child.get());
  btRigidBody& body = world.add(compound, kMass, btVector3(3, 0, btScalar(0.5 - kDepth)));
  world.run(kStep);
  auto pairs = pairOverlaps(&world.dispatcher);
  ASSERT_EQ(pairs.size(), 2u);
  if (pairs[0].centroid.x() > pairs[1].centroid.x()) std::swap(pairs[0], pairs[1]);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(pairs[i].a, &body);
    EXPECT_EQ(pairs[i].b, &floor);
    EXPECT_NEAR(pairs[i].volume, cutVolume(kDepth), 1e-3 * cutVolume(kDepth));
    EXPECT_NEAR(pairs[i].centroid.x(), 2 + 2 * i, 1e-3);
    EXPECT_LT(pairs[i].force.z(), 0);
  }
  const double impulse = -kStep * (pairs[0].force.z() + pairs[1].force.z());
  EXPECT_NEAR(body.getLinearVelocity().z(), impulse / kMass, 1e-3 * impulse);
}

TEST(PairOverlaps, BodiesApartAreNotListed) {
  TestWorld world;
  world.addFloor();
  world.add(makeShape(latticeBox({1, 1, 1}, 4)), 1, btVector3(0, 0, 5));
  world.run(1.0 / 60);
  EXPECT_TRUE(pairOverlaps(&world.dispatcher).empty());
}

TEST(PairOverlaps, UnregisteredDispatcherIsAnError) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  for (btCollisionDispatcher* d : {&dispatcher, static_cast<btCollisionDispatcher*>(nullptr)}) {
    try {
      pairOverlaps(d);
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    }
  }
}

class CountingDrawer : public btIDebugDraw {
 public:
  void drawLine(const btVector3&, const btVector3&, const btVector3&) override { ++lines; }
  void drawSphere(btScalar radius, const btTransform&, const btVector3&) override { radii.push_back(radius); }
  void drawSphere(const btVector3&, btScalar radius, const btVector3&) override { radii.push_back(radius); }
  void drawContactPoint(const btVector3&, const btVector3&, btScalar, int, const btVector3&) override {}
  void reportErrorWarning(const char*) override {}
  void draw3dText(const btVector3&, const char*) override {}
  void setDebugMode(int) override {}
  int getDebugMode() const override { return DBG_DrawNormals; }

  int lines = 0;
  std::vector<btScalar> radii;
};

TEST(ContactDrawer, DrawsWhatWasAskedFor) {
  TestWorld world;
  world.addFloor();
  const Packing packing = latticeBox({1, 1, 1}, 4);
  btRigidBody& cube = world.add(makeShape(packing), 1, btVector3(0, 0, btScalar(0.5)));
  cube.setActivationState(DISABLE_DEACTIVATION);
  world.run(1);
  CountingDrawer drawer;
  world.world.setDebugDrawer(&drawer);
  const auto draw = [&](const ContactDrawerOptions& options) {
    drawer.lines = 0;
    drawer.radii.clear();
    ContactDrawer contacts(world.world, options);
    world.world.addAction(&contacts);
    world.world.debugDrawWorld();
    world.world.removeAction(&contacts);
  };
  ContactDrawerOptions options;
  options.volumes = false;
  draw(options);
  EXPECT_EQ(drawer.lines, 6 + 4);  // sides and diagonals of four points, and their normals
  EXPECT_TRUE(drawer.radii.empty());
  options = {false, false, false, true};
  draw(options);
  EXPECT_EQ(drawer.lines, 0);
  ASSERT_EQ(drawer.radii.size(), packing.spheres.size());
  EXPECT_FLOAT_EQ(float(drawer.radii[0]), packing.spheres[0].radius);
  world.world.setDebugDrawer(nullptr);
}

TEST(ContactDrawer, AVolumeIsABallOfThatVolume) {
  TestWorld world;
  world.world.setGravity(btVector3(0, 0, 0));
  world.addFloor();
  world.add(makeShape(latticeBox({1, 1, 1}, kCells)), 1, btVector3(0, 0, btScalar(0.5 - 0.03)));
  world.run(1.0 / 60);
  CountingDrawer drawer;
  ContactDrawer contacts(world.world, {false, false, true, false});
  contacts.debugDraw(&drawer);
  ASSERT_EQ(drawer.radii.size(), 1u);
  EXPECT_NEAR(4.0 / 3 * M_PI * std::pow(double(drawer.radii[0]), 3),
              pairOverlaps(&world.dispatcher).at(0).volume, 1e-6);
}

}  // namespace
}  // namespace innersphere::test
