// The checker finds what is planted.
#include "innersphere/check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "analytic_solids.hpp"
#include "packer_oracles.hpp"

namespace innersphere::test {
namespace {

/// Spheres on a lattice in the unit cube, a little apart, of slightly falling radius.
Packing lattice(int n) {
  Packing packing;
  for (int i = 0; i < n * n * n; ++i) {
    const auto at = [&](int k) { return (static_cast<float>(k) + 0.5f) / static_cast<float>(n) - 0.5f; };
    const float radius =
        0.45f / static_cast<float>(n) * (1 - 1e-4f * static_cast<float>(i) / static_cast<float>(n * n * n));
    packing.spheres.push_back({at(i % n), at(i / n % n), at(i / n / n), radius});
  }
  std::shuffle(packing.spheres.begin(), packing.spheres.end(), std::mt19937(3));
  std::sort(packing.spheres.begin(), packing.spheres.end(),
            [](const Sphere& a, const Sphere& b) { return a.radius > b.radius; });
  return packing;
}

TEST(Check, AcceptsAValidPacking) {
  const Cube cube;
  const Packing packing = lattice(8);
  const CheckReport report = check(packing, &cube);
  EXPECT_TRUE(report.valid());
  EXPECT_NEAR(report.worst_overlap, static_cast<double>(worstOverlap(packing)), 1e-15);
  EXPECT_NEAR(report.worst_protrusion, 0.45 / 8 - 0.5 / 8, 1e-8);
  EXPECT_NEAR(report.density, 4.0 / 3.0 * std::numbers::pi * std::pow(0.45, 3), 1e-4);
}

TEST(Check, FindsAPlantedOverlap) {
  for (std::size_t victim : {0u, 100u, 511u}) {
    Packing packing = lattice(8);
    Sphere moved = packing.spheres[victim];
    moved.radius = 1e-3f;
    moved.x += 0.9f * packing.spheres[victim].radius;
    packing.spheres.push_back(moved);
    const CheckReport report = check(packing);
    EXPECT_FALSE(report.valid());
    EXPECT_EQ(report.overlap_i, victim);
    EXPECT_EQ(report.overlap_j, 512u);
    EXPECT_NEAR(report.worst_overlap, static_cast<double>(worstOverlap(packing)), 1e-15);
    EXPECT_GT(report.worst_overlap, 0);
  }
}

TEST(Check, FindsTheSmallestOverlap) {
  Packing packing;
  packing.spheres = {{0, 0, 0, 1}, {1.5f, 0, 0, 0.5f}};
  EXPECT_TRUE(check(packing).valid());
  EXPECT_EQ(check(packing).worst_overlap, 0);
  packing.spheres[0].radius = std::nextafter(1.0f, 2.0f);
  EXPECT_FALSE(check(packing).valid());
  EXPECT_EQ(check(packing).worst_overlap, double{std::nextafter(1.0f, 2.0f)} - 1);
}

TEST(Check, EqualsBruteForceOnRandomSpheres) {
  std::mt19937 random(17);
  std::uniform_real_distribution<float> unit(0, 1);
  for (int round = 0; round < 30; ++round) {
    Packing packing;
    const float size = std::pow(10.0f, -3 * unit(random));
    for (int i = 0; i < 100; ++i) {
      packing.spheres.push_back({unit(random), unit(random), unit(random), size * unit(random) + 1e-6f});
    }
    const CheckReport report = check(packing);
    EXPECT_NEAR(report.worst_overlap, static_cast<double>(worstOverlap(packing)), 1e-15);
    const Sphere &a = packing.spheres[report.overlap_i], &b = packing.spheres[report.overlap_j];
    EXPECT_NEAR(static_cast<double>(Real{a.radius} + b.radius - distance(a, b)), report.worst_overlap, 1e-15);
    EXPECT_FALSE(report.sorted);
  }
}

TEST(Check, FindsAPlantedProtrusion) {
  const Cube cube;
  Packing packing = lattice(8);
  packing.spheres.push_back({0.49f, 0.01f, 0.01f, 0.02f});
  CheckReport report = check(packing, &cube);
  EXPECT_EQ(report.protruding, 512u);
  EXPECT_NEAR(report.worst_protrusion, 0.01, 1e-7);
  EXPECT_FALSE(report.valid());
  // Wholly outside.
  packing.spheres.back() = {2, 0, 0, 0.02f};
  report = check(packing, &cube);
  EXPECT_EQ(report.protruding, 512u);
  EXPECT_NEAR(report.worst_protrusion, 1.52, 1e-6);
}

TEST(Check, FindsWrongOrder) {
  Packing packing = lattice(4);
  std::swap(packing.spheres[10], packing.spheres[11]);
  EXPECT_FALSE(check(packing).sorted);
  EXPECT_FALSE(check(packing).valid());
}

TEST(Check, NumbersThatAreNotFinite) {
  for (float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    for (int field = 0; field < 4; ++field) {
      Packing packing = lattice(3);
      Sphere& s = packing.spheres[5];
      (field == 0 ? s.x : field == 1 ? s.y : field == 2 ? s.z : s.radius) = bad;
      const CheckReport report = check(packing);
      EXPECT_FALSE(report.valid());
      EXPECT_EQ(report.overlap_i, 5u);
    }
  }
}

TEST(Check, OneSphereAndNone) {
  Packing packing;
  EXPECT_TRUE(check(packing).valid());
  packing.spheres = {{0, 0, 0, 1}};
  EXPECT_TRUE(check(packing).valid());
  const Cube cube;
  EXPECT_NEAR(check(packing, &cube).worst_protrusion, 0.5, 1e-12);
}

}  // namespace
}  // namespace innersphere::test
