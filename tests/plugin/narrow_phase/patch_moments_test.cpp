// Moments of contacts whose sums can be written down, and the points that stand for them.
#include "narrow_phase/patch_moments.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace innersphere::test {
namespace {

constexpr double kHalfX = 0.3, kHalfY = 0.1, kDepth = 0.01, kArea = 0.002;

std::vector<std::size_t> all(const std::vector<SphereContact>& contacts) {
  std::vector<std::size_t> indices(contacts.size());
  std::iota(indices.begin(), indices.end(), std::size_t(0));
  return indices;
}

PatchMoments momentsOf(const std::vector<SphereContact>& contacts) {
  return patchMoments(contacts, all(contacts), btMatrix3x3::getIdentity());
}

/// A grid of contacts over a rectangle in the plane z = 2; their depth slopes along x.
std::vector<SphereContact> grid(double slope, int n = 9) {
  std::vector<SphereContact> contacts;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double x = kHalfX * (2.0 * i / (n - 1) - 1), y = kHalfY * (2.0 * j / (n - 1) - 1);
      SphereContact contact;
      contact.area = {0, 0, float(kArea)};
      contact.centroid = {float(x + 5), float(y), 2};
      contact.volume = float(kArea * (kDepth + slope * x));
      contacts.push_back(contact);
    }
  }
  return contacts;
}

/// Mean square of n equally spaced places from -half to half.
double meanSquare(double half, int n) {
  return half * half * (n + 1) / (3.0 * (n - 1));
}

TEST(PatchMoments, OfARectangle) {
  const PatchMoments m = momentsOf(grid(0.02));
  EXPECT_NEAR(m.area, 81 * kArea, 1e-6);
  EXPECT_NEAR(m.volume, 81 * kArea * kDepth, 1e-7);
  EXPECT_NEAR(m.normal.distance(btVector3(0, 0, 1)), 0, 1e-6);
  EXPECT_NEAR(m.centre.distance(btVector3(5, 0, 2)), 0, 1e-5);
  // The tangents are the axes, in either order.
  const int along = std::fabs(m.tangent[0].x()) > 0.5 ? 0 : 1, across = 1 - along;
  EXPECT_NEAR(std::fabs(m.tangent[along].x()), 1, 1e-6);
  EXPECT_NEAR(m.tangent[0].cross(m.tangent[1]).distance(m.normal), 0, 1e-6);
  EXPECT_NEAR(m.spread[2 * along], meanSquare(kHalfX, 9), 1e-5);
  EXPECT_NEAR(m.spread[1], 0, 1e-6);
  EXPECT_NEAR(m.spread[2 * across], meanSquare(kHalfY, 9), 1e-6);
  EXPECT_NEAR(m.slope[along] * m.tangent[along].x(), 0.02, 1e-4);
  EXPECT_NEAR(m.slope[across], 0, 1e-4);
  double radius = 0;  // of discs, by many places on each
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  constexpr int kPlaces = 200000;
  for (int k = 0; k < kPlaces; ++k) {
    double u, v;
    do u = uniform(rng), v = uniform(rng);
    while (u * u + v * v > 1);
    const double disc = std::sqrt(kArea / M_PI);
    radius += std::hypot(kHalfX * (k % 9 - 4) / 4.0 + disc * u, kHalfY * (k / 9 % 9 - 4) / 4.0 + disc * v) /
              kPlaces;
  }
  EXPECT_NEAR(m.radius, radius, 1e-3 * radius);
}

TEST(PatchMoments, TurnWithTheirReference) {
  const std::vector<SphereContact> contacts = grid(0);
  const btMatrix3x3 turn(btQuaternion(btVector3(0, 0, 1), btScalar(0.4)));
  const PatchMoments still = momentsOf(contacts), turned = patchMoments(contacts, all(contacts), turn);
  EXPECT_NEAR(turned.tangent[0].distance(turn * still.tangent[0]), 0, 1e-5);
  // Turned back they are the same ellipse.
  const double c = std::cos(0.4), s = std::sin(0.4);
  const double back = c * c * turned.spread[0] - 2 * c * s * turned.spread[1] + s * s * turned.spread[2];
  EXPECT_NEAR(back, still.spread[0], 1e-5);
}

TEST(PatchMoments, OfOpposedAreasHaveNoNormal) {
  std::vector<SphereContact> contacts(2);
  contacts[0].area = {0, 0, 0.5F};
  contacts[1].area = {0, 0, -0.5F};
  EXPECT_EQ(momentsOf(contacts).area, 0);
}

/// Four points of equal weight push as much, and turn as much, as all the volume does.
void expectSameWrench(const std::vector<SphereContact>& contacts) {
  const PatchMoments m = momentsOf(contacts);
  ContactPatch patch;
  pointsFromMoments(m, btScalar(1e-4), patch);
  ASSERT_EQ(patch.count, 4);
  double volume = 0, moment[3] = {}, found = 0, turns[3] = {};
  for (const SphereContact& c : contacts) {
    volume += c.volume;
    for (int k = 0; k < 3; ++k) moment[k] += double(c.volume) * (c.centroid[k] - m.centre[k]);
  }
  for (int i = 0; i < 4; ++i) {
    const double share = patch.points[i].depth * m.area / 4;
    EXPECT_GE(patch.points[i].depth, -1e-7);
    found += share;
    const btVector3 middle = patch.points[i].on_b + patch.points[i].normal * (patch.points[i].depth / 2);
    for (int k = 0; k < 3; ++k) turns[k] += share * (middle[k] - m.centre[k]);
  }
  EXPECT_NEAR(found, volume, 1e-4 * volume);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(turns[k], moment[k], 1e-3 * volume * kHalfX) << k;
}

TEST(PointsFromMoments, PushAndTurnAsTheVolumeDoes) {
  expectSameWrench(grid(0));
  expectSameWrench(grid(0.02));
  expectSameWrench(grid(-0.03));
  // Askew, with any depths that vary little.
  std::mt19937 rng(4);
  std::uniform_real_distribution<float> u(-0.3F, 0.3F), d(0.009F, 0.011F);
  std::vector<SphereContact> contacts(60);
  for (SphereContact& c : contacts) {
    c.area = {float(kArea), float(kArea), 0};
    const float along = u(rng), up = u(rng) * 0.5F;
    c.centroid = {along, -along, up};
    c.volume = float(kArea) * 1.4142F * d(rng);
  }
  expectSameWrench(contacts);
}

TEST(PointsFromMoments, AreSpreadBySqrt3StandardDeviations) {
  ContactPatch patch;
  const PatchMoments m = momentsOf(grid(0));
  pointsFromMoments(m, btScalar(1e-4), patch);
  for (int i = 0; i < patch.count; ++i) {
    EXPECT_NEAR(std::fabs(patch.points[i].on_b.x() - 5), std::sqrt(3 * meanSquare(kHalfX, 9)), 1e-4);
    EXPECT_NEAR(std::fabs(patch.points[i].on_b.y()), std::sqrt(3 * meanSquare(kHalfY, 9)), 1e-4);
    EXPECT_NEAR(patch.points[i].depth, kDepth, 1e-6);
  }
}

TEST(PointsFromMoments, LiftNoCornerOutOfTheContact) {
  // Steeper than a wedge that begins at one side: the sum of the depths stays.
  PatchMoments m = momentsOf(grid(0));
  m.slope[0] = 10;
  ContactPatch patch;
  pointsFromMoments(m, btScalar(1e-4), patch);
  double sum = 0;
  for (int i = 0; i < patch.count; ++i) {
    EXPECT_GE(patch.points[i].depth, -1e-7);
    sum += patch.points[i].depth;
  }
  EXPECT_NEAR(sum, 4 * kDepth, 1e-5);
}

TEST(PointsFromMoments, AreOneInTheMiddleOfASmallPatch) {
  ContactPatch patch;
  pointsFromMoments(momentsOf(grid(0.02)), 2, patch);
  ASSERT_EQ(patch.count, 1);
  EXPECT_NEAR(patch.points[0].depth, kDepth, 1e-6);
  EXPECT_NEAR(patch.points[0].on_b.distance(btVector3(5, 0, btScalar(2 - kDepth / 2))), 0, 1e-5);
}

TEST(PointsFromMoments, AreNoneWithoutDepth) {
  PatchMoments m = momentsOf(grid(0));
  m.volume = 0;
  ContactPatch patch;
  pointsFromMoments(m, btScalar(1e-4), patch);
  EXPECT_EQ(patch.count, 0);
}

}  // namespace
}  // namespace innersphere::test
