// Solids known by their distance only, against closed forms.
#include <gtest/gtest.h>

#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/solids.hpp"
#include "mesh_oracles.hpp"
#include "mesh_shapes.hpp"

namespace innersphere::test {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(SolidsDistance, BallFromAFunction) {
  const Vec3d middle{3, -2, 1};
  const auto ball = makeDistanceSolid(
      "ball", [&](const Vec3d& p) { return std::hypot(p[0] - 3, p[1] + 2, p[2] - 1) - 0.5; },
      {{2.5, -2.5, 0.5}, {3.5, -1.5, 1.5}}, 64);
  const MassProperties mass = ball->massProperties();
  EXPECT_NEAR(mass.volume / (kPi / 6), 1, 1e-3);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(mass.centre_of_mass[k], middle[k], 1e-4);
  EXPECT_NEAR(mass.inertia[4] / (0.4 * kPi / 6 * 0.25), 1, 2e-3);
  std::mt19937 random(21);
  for (int trial = 0; trial < 500; ++trial) {
    const Vec3d p = randomPoint(random, {2.5, -2.5, 0.5}, {3.5, -1.5, 1.5});
    const ClosestPoint c = ball->closestPoint(p);
    EXPECT_NEAR(c.distance, std::abs(std::hypot(p[0] - 3, p[1] + 2, p[2] - 1) - 0.5), 1e-15);
    EXPECT_NEAR(std::hypot(c.point[0] - 3, c.point[1] + 2, c.point[2] - 1), 0.5, 1e-9);
    EXPECT_NEAR(std::hypot(c.point[0] - p[0], c.point[1] - p[1], c.point[2] - p[2]), c.distance, 1e-8);
  }
  const Mesh mesh = ball->surface();
  EXPECT_TRUE(isClosedManifold(mesh));
  EXPECT_EQ(eulerCharacteristic(mesh), 2);
  EXPECT_NEAR(volumeOf(mesh) / (kPi / 6), 1, 0.01);
}

TEST(SolidsDistance, RefusesWhatCannotBeSampled) {
  const auto ball = [](const Vec3d& p) { return std::hypot(p[0], p[1], p[2]) - 0.5; };
  EXPECT_THROW(makeDistanceSolid("x", ball, {{0, 0, 0}, {0, 1, 1}}), Error);
  EXPECT_THROW(makeDistanceSolid("x", ball, {{0, 0, 0}, {1, 1, 1}}, 0), Error);
  EXPECT_THROW(makeDistanceSolid("x", nullptr, {{0, 0, 0}, {1, 1, 1}}), Error);
  try {
    makeDistanceSolid("outside", ball, {{2, 2, 2}, {3, 3, 3}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::not_a_solid);
  }
}

// What a drill of radius r through the middle leaves of a ball has the volume of a ball as high as the hole.
TEST(SolidsDifference, NapkinRing) {
  const double drill = 0.3, half = std::sqrt(0.25 - drill * drill);
  const auto ring = makeDifference(makeBall(0.5), makeCylinder(drill, 2));
  const MassProperties mass = ring->massProperties();
  EXPECT_NEAR(mass.volume / (4 * kPi / 3 * half * half * half), 1, 1e-3);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(mass.centre_of_mass[k], 0, 1e-4);
  std::mt19937 random(22);
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3d p = randomPoint(random, {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    const double rho = std::hypot(p[0], p[1]);
    const bool inside = std::hypot(rho, p[2]) < 0.5 && rho > drill;
    EXPECT_EQ(ring->contains(p), inside);
    if (!inside) continue;
    const double exact = std::min(0.5 - std::hypot(rho, p[2]), rho - drill);
    EXPECT_NEAR(ring->closestPoint(p).distance, exact, 1e-14);
    EXPECT_TRUE(std::isinf(ring->closestPoint(p, 0.99 * exact).distance));
  }
  const Mesh mesh = ring->surface();
  EXPECT_TRUE(isClosed(mesh));
  EXPECT_NEAR(volumeOf(mesh) / mass.volume, 1, 0.03);
}

// A mesh with an analytic hole: representations mix.
TEST(SolidsDifference, MeshMinusBall) {
  const auto block = makeDifference(makeSolid(boxMesh(), "box"), makeBall(0.4));
  const double expected = 1 - 4 * kPi / 3 * 0.064;
  EXPECT_NEAR(block->massProperties().volume / expected, 1, 1e-3);
  EXPECT_FALSE(block->contains({0, 0, 0.39}));
  EXPECT_TRUE(block->contains({0, 0, 0.41}));
  EXPECT_NEAR(block->closestPoint({0, 0, 0.42}).distance, 0.02, 1e-15);
  EXPECT_NEAR(block->closestPoint({0, 0, 0.47}).distance, 0.03, 1e-15);
  EXPECT_FALSE(block->hash().empty());
}

TEST(SolidsDifference, NothingLeftIsAnError) {
  EXPECT_THROW(makeDifference(makeBall(0.5), makeBall(0.6)), Error);
  EXPECT_THROW(makeDifference(nullptr, makeBall(0.6)), Error);
}

}  // namespace
}  // namespace innersphere::test
