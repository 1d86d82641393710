// Where bodies touch is found however fast they are, and so however far apart surfaces are looked at.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "innersphere/pair_overlaps.hpp"
#include "innersphere/substep_solver.hpp"
#include "named_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kRing = 0.1, kTube = 0.025;  // [m] radii of both rings
constexpr double kDepth = 5e-4;               // [m] in each other
constexpr double kStep = 1.0 / 60;

/// The deepest contact found at linked rings that hang in each other along x, turned by these angles about
/// their own axes, while the second one spins about its own [rad/s].
double depthFound(const std::shared_ptr<PackingShape>& shape, double turn_a, double turn_b, double spin) {
  TestWorld world;
  world.world.setGravity(btVector3(0, 0, 0));
  const btQuaternion on_edge(btVector3(1, 0, 0), SIMD_HALF_PI);
  const btTransform a(btQuaternion(btVector3(0, 0, 1), btScalar(turn_a)), btVector3(0, 0, 0));
  const btTransform b(on_edge * btQuaternion(btVector3(0, 0, 1), btScalar(turn_b)),
                      btVector3(btScalar(2 * (kRing - kTube) + kDepth), 0, 0));
  for (const btTransform& pose : {a, b}) {
    const btTransform at = shape->bodyTransform(pose);
    world.add(shape, 1, at.getOrigin(), at.getRotation());
  }
  world.bodies[1]->setAngularVelocity(btVector3(0, btScalar(spin), 0));
  world.world.getDispatchInfo().m_timeStep = btScalar(kStep);
  world.world.performDiscreteCollisionDetection();
  const std::vector<PairOverlap> pairs = pairOverlaps(&world.dispatcher);
  return pairs.empty() ? -1 : pairs[0].depth;
}

TEST(FastPair, RingsTouchWhereTheyHangInEachOther) {
  const std::shared_ptr<PackingShape> shape = makeFineTorusShape(kRing, kTube, 500);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(0, 2 * M_PI);
  for (int i = 0; i < 20; ++i) {
    const double turn_a = angle(random), turn_b = angle(random);
    // A ring that spins about its own axis is where it was: what it touches is the same at any speed.
    for (const double spin : {0.0, 10.0, 30.0, 45.0, 60.0})
      EXPECT_NEAR(depthFound(shape, turn_a, turn_b, spin), kDepth, kDepth / 2)
          << "placement " << i << ", " << spin << " rad/s";
  }
}

constexpr double kRadius = 0.1, kAbove = 0.08, kBetween = 0.008;  // [m] of balls: above the slope, between

/// How deep the upper ball gets into the lower one as both fall on to a slope, or past it [m].
double depthOnLanding(double beside) {
  TestWorld world;
  SubstepSolver solver;
  world.world.setConstraintSolver(&solver);
  PackingCollisionAlgorithm::prepareWorld(world.world);
  const btQuaternion turn(btVector3(0, 1, 0), SIMD_HALF_PI / 2);
  const btVector3 normal = quatRotate(turn, btVector3(0, 0, 1));
  world.add(std::make_shared<btBoxShape>(btVector3(1, 1, 1)), 0, btVector3(0, btScalar(beside), 0) - normal,
            turn);
  const std::shared_ptr<PackingShape> ball = makeFineBallShape(kRadius, 100);
  const double lower = (kRadius + kAbove) / normal.z();
  for (const double height : {lower, lower + 2 * kRadius + kBetween})
    world.add(ball, 1, btVector3(0, 0, btScalar(height))).setLinearVelocity(btVector3(0, 0, -3));
  double nearest = 2 * kRadius;
  for (int i = 0; i < 10; ++i) {
    world.run(kStep, kStep);
    nearest = std::min(nearest, double(world.bodies[2]->getWorldTransform().getOrigin().distance(
                                    world.bodies[1]->getWorldTransform().getOrigin())));
  }
  world.world.setConstraintSolver(&world.solver);
  return 2 * kRadius - nearest;
}

TEST(FastPair, WhatFliesWithABodyThatIsStoppedIsStoppedByIt) {
  // In a step they fall by 50 mm, and keep their distance until the lower one lands.
  EXPECT_LT(depthOnLanding(0), 0.01 * kRadius);
  EXPECT_LT(depthOnLanding(2), 1e-6);
}

}  // namespace
}  // namespace innersphere::test
