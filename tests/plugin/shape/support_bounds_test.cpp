#include "shape/support_bounds.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "common/bullet_vectors.hpp"
#include "test_packings.hpp"

namespace innersphere::test {
namespace {

constexpr float kTube = 0.3f;

btVector3 randomDirection(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  return btVector3(btScalar(normal(rng)), btScalar(normal(rng)), btScalar(normal(rng))).normalized();
}

btMatrix3x3 randomRotation(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  const btQuaternion q(btScalar(normal(rng)), btScalar(normal(rng)), btScalar(normal(rng)),
                       btScalar(normal(rng)));
  return btMatrix3x3(q.normalized());
}

/// Balls along a ring of 1 m about the z axis.
Packing ring() {
  Packing packing = withoutSurface(latticeBox({2.6, 2.6, 0.6}, 1));
  packing.spheres.clear();
  constexpr int kBalls = 64;
  for (int i = 0; i < kBalls; ++i) {
    const double angle = 2 * M_PI * i / kBalls;
    packing.spheres.push_back({float(std::cos(angle)), float(std::sin(angle)), 0, kTube});
  }
  return packing;
}

/// Straight from what a support function is.
btScalar reachOf(const Packing& packing, const btTransform& frame, const btVector3& direction) {
  btScalar reach = -BT_LARGE_FLOAT;
  for (const auto& v : packing.surface.vertices) reach = btMax(reach, (frame * toBullet(v)).dot(direction));
  for (const Sphere& s : packing.spheres)
    reach = btMax(reach, (frame * centre(s)).dot(direction) + btScalar(s.radius) * direction.length());
  return reach;
}

TEST(SupportBounds, AreNeverTooSmallAndLittleTooLarge) {
  std::mt19937 rng(7);
  const btTransform frame(randomRotation(rng), btVector3(btScalar(0.2), btScalar(-0.1), btScalar(0.3)));
  for (const Packing& packing : {ring(), latticeBox({1, 0.5, 0.25}, 3), withoutSurface(singleBall(0.5))}) {
    const SupportBounds bounds(packing, frame);
    btScalar size = 0;
    for (int i = 0; i < 3; ++i) {
      btVector3 axis(0, 0, 0);
      axis[i] = 1;
      const btScalar up = reachOf(packing, frame, axis), down = reachOf(packing, frame, -axis);
      EXPECT_NEAR(bounds.along(axis), up, 1e-6);
      EXPECT_NEAR(bounds.along(-axis), down, 1e-6);
      size = std::hypot(size, up + down);
    }
    for (int trial = 0; trial < 2000; ++trial) {
      const btVector3 direction = randomDirection(rng) * btScalar(trial % 7 + 1);
      const btScalar exact = reachOf(packing, frame, direction), slack = btScalar(1e-6) * direction.length();
      EXPECT_GE(bounds.along(direction), exact - slack);
      EXPECT_LE(bounds.along(direction), exact + btScalar(0.04) * size * direction.length());
    }
  }
}

TEST(SupportBounds, OfABoxAlongTheAxesAreExactInAllDirections) {
  const Packing packing = latticeBox({1, 2, 3}, 2);
  const SupportBounds bounds(packing, btTransform::getIdentity());
  std::mt19937 rng(8);
  for (int trial = 0; trial < 500; ++trial) {
    const btVector3 d = randomDirection(rng);
    EXPECT_NEAR(bounds.along(d), btFabs(d.x()) / 2 + btFabs(d.y()) + btFabs(d.z()) * btScalar(1.5), 1e-5);
  }
}

TEST(SupportBounds, OfWhatIsNotFiniteAreNoNumber) {
  const SupportBounds bounds(latticeBox({1, 2, 3}, 2), btTransform::getIdentity());
  for (const btScalar bad :
       {std::numeric_limits<btScalar>::quiet_NaN(), std::numeric_limits<btScalar>::infinity()}) {
    for (int i = 0; i < 3; ++i) {
      btVector3 direction(0, 0, 1);
      direction[i] = bad;
      EXPECT_FALSE(std::isfinite(bounds.along(direction)));
    }
  }
}

/// A torus reaches as far as its ring, seen along the axis, and its tube.
TEST(SupportBounds, MakeBoxesHardlyLargerThanARing) {
  const auto shape = makeShape(ring());
  std::mt19937 rng(9);
  double ratio = 0;
  constexpr int kTrials = 500;
  for (int trial = 0; trial < kTrials; ++trial) {
    const btTransform pose(randomRotation(rng), btVector3(1, 2, 3));
    btVector3 min, max;
    shape->getAabb(pose, min, max);
    const btMatrix3x3 axes = pose.getBasis() * shape->principalTransform().getBasis();
    double smallest = 1, made = 1;
    for (int i = 0; i < 3; ++i) {
      smallest *= 2 * (std::hypot(axes[i][0], axes[i][1]) + kTube);
      made *= max[i] - min[i];
    }
    ratio += made / smallest / kTrials;
  }
  EXPECT_GT(ratio, 0.99);  // it is made of balls, which lie within it
  EXPECT_LT(ratio, 1.04);
}

}  // namespace
}  // namespace innersphere::test
