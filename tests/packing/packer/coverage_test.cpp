// How near spheres come to the surface: what a packing says of it, and the order that sees to it.
#include <gtest/gtest.h>

#include <algorithm>

#include "innersphere/check.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/packer.hpp"
#include "mesh_shapes.hpp"
#include "packer_oracles.hpp"

namespace innersphere::test {
namespace {

/// A cup of radius 0.5 and height 1 with walls of 0.01, and a foot of 0.1.
Mesh cupMesh() {
  const std::vector<std::array<double, 2>> profile{{0.5, 0}, {0.5, 1}, {0.49, 1}, {0.49, 0.1}};
  constexpr int kAround = 64;
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {0, 0, 0.1}};
  for (const auto& [r, z] : profile) {
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * std::numbers::pi * i / kAround;
      mesh.vertices.push_back({r * std::cos(angle), r * std::sin(angle), z});
    }
  }
  const auto at = [&](std::size_t ring, int i) {
    return static_cast<std::uint32_t>(2 + ring * kAround + static_cast<std::size_t>(i % kAround));
  };
  for (int i = 0; i < kAround; ++i) {
    mesh.triangles.push_back({0, at(0, i + 1), at(0, i)});
    for (std::size_t ring = 0; ring + 1 < profile.size(); ++ring) {
      mesh.triangles.push_back({at(ring, i), at(ring, i + 1), at(ring + 1, i + 1)});
      mesh.triangles.push_back({at(ring, i), at(ring + 1, i + 1), at(ring + 1, i)});
    }
    mesh.triangles.push_back({1, at(3, i), at(3, i + 1)});
  }
  return mesh;
}

Packing packCup(SphereOrder order, std::size_t spheres, int threads = 0) {
  PackOptions options;
  options.spheres = spheres;
  options.order = order;
  options.overlap_errors = false;
  options.threads = threads;
  return pack(*makeSolid(cupMesh(), "cup"), options);
}

/// With 256 spheres; packed once for all tests.
const Packing& packedCup(SphereOrder order) {
  static const Packing by_radius = packCup(SphereOrder::radius, 256);
  static const Packing covering = packCup(SphereOrder::coverage, 256);
  return order == SphereOrder::radius ? by_radius : covering;
}

/// Distances of random points of the cup's surface from the first spheres, by brute force, sorted.
std::vector<double> gapsOf(const Packing& packing, std::size_t count) {
  const Mesh cup = cupMesh();
  std::vector<double> area;
  for (const auto& t : cup.triangles) {
    const Vec3d& a = cup.vertices[t[0]];
    area.push_back((area.empty() ? 0 : area.back()) +
                   norm(cross(cup.vertices[t[1]] - a, cup.vertices[t[2]] - a)));
  }
  std::mt19937 random(41);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<double> gaps;
  for (int i = 0; i < 20000; ++i) {
    const double target = unit(random) * area.back();
    const auto& t = cup.triangles[static_cast<std::size_t>(
        std::lower_bound(area.begin(), area.end(), target) - area.begin())];
    double u = unit(random), v = unit(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Vec3d &a = cup.vertices[t[0]], &b = cup.vertices[t[1]], &c = cup.vertices[t[2]];
    const Vec3d p = a + u * (b - a) + v * (c - a);
    double gap = 1e9;
    for (std::size_t s = 0; s < count; ++s) {
      const Sphere& ball = packing.spheres[s];
      gap = std::min(gap, norm(p - Vec3d{ball.x, ball.y, ball.z}) - ball.radius);
    }
    gaps.push_back(gap);
  }
  std::sort(gaps.begin(), gaps.end());
  return gaps;
}

const double kDiagonal = norm(Vec3d{1, 1, 1});

TEST(Coverage, IsWhatBruteForceFindsForEachPrefix) {
  for (const SphereOrder order : {SphereOrder::radius, SphereOrder::coverage}) {
    const Packing& packing = packedCup(order);
    ASSERT_EQ(packing.coverage.size(), 3u);
    constexpr std::uint32_t counts[] = {64, 128, 256};
    for (std::size_t i = 0; i < 3; ++i) {
      const Coverage& coverage = packing.coverage[i];
      EXPECT_EQ(coverage.count, counts[i]);
      const std::vector<double> gaps = gapsOf(packing, coverage.count);
      const auto size = static_cast<double>(gaps.size());
      double mean = 0;
      for (double gap : gaps) mean += std::max(gap, 0.0) / size;
      EXPECT_NEAR(coverage.mean, mean, 0.03 * mean);
      EXPECT_NEAR(coverage.p95, gaps[gaps.size() * 95 / 100], 0.03 * coverage.p95);
      EXPECT_NEAR(coverage.max, gaps.back(), 0.05 * coverage.max);
      const auto bare = gaps.end() - std::upper_bound(gaps.begin(), gaps.end(), 0.01 * kDiagonal);
      EXPECT_NEAR(coverage.uncovered, static_cast<double>(bare) / size, 0.02);
    }
    EXPECT_EQ(coverageOf(packing, 200)->count, 128u);
    EXPECT_EQ(coverageOf(packing, 63), nullptr);
    EXPECT_EQ(packing.quality.gap_max, packing.coverage.back().max);
  }
}

TEST(Coverage, ItsOrderPutsSpheresIntoAllWalls) {
  const Packing& by_radius = packedCup(SphereOrder::radius);
  const Packing& covering = packedCup(SphereOrder::coverage);
  EXPECT_EQ(covering.order, SphereOrder::coverage);
  EXPECT_GT(gapsOf(by_radius, 256)[10000], 0.1);
  EXPECT_LT(gapsOf(covering, 256).back(), 0.1);
  EXPECT_LT(gapsOf(covering, 64).back(), 0.2);
}

TEST(Coverage, ItsOrderKeepsSpheresInsideAndDisjoint) {
  const auto solid = makeSolid(cupMesh(), "cup");
  const Packing packing = packCup(SphereOrder::coverage, 1000);
  EXPECT_EQ(packing.spheres.size(), 1000u);
  EXPECT_TRUE(check(packing, solid.get()).valid());
  EXPECT_LE(worstOverlap(packing), 0);
  EXPECT_NO_THROW(validate(packing));
  EXPECT_FALSE(std::is_sorted(packing.spheres.begin(), packing.spheres.end(),
                              [](const Sphere& a, const Sphere& b) { return a.radius > b.radius; }));
}

TEST(Coverage, ItsOrderDoesNotDependOnThreads) {
  EXPECT_TRUE(sameBytes(packCup(SphereOrder::coverage, 300, 1), packCup(SphereOrder::coverage, 300, 3)));
}

TEST(Coverage, OfAGapIsReachedWithTheFewestSpheres) {
  PackOptions options;
  options.spheres = 0;
  options.gap = 0.05;
  options.order = SphereOrder::coverage;
  options.overlap_errors = false;
  const Packing packing = pack(*makeSolid(cupMesh(), "cup"), options);
  EXPECT_LE(packing.quality.gap_max, 0.05);
  // The packer looks at 50,000 points of 4.9 m^2 of surface, which lie 0.01 m apart.
  const std::vector<double> gaps = gapsOf(packing, packing.spheres.size());
  EXPECT_LT(gaps[gaps.size() * 995 / 1000], 0.05);
  EXPECT_LT(gaps.back(), 0.05 + 0.01);
  EXPECT_GT(gapsOf(packing, packing.spheres.size() * 3 / 4).back(), 0.05);
}

TEST(Coverage, BareWallsAreNamedWithTheNumberThatWouldDo) {
  const auto bare = [](const Packing& packing) {
    return std::any_of(packing.warnings.begin(), packing.warnings.end(), [](const std::string& warning) {
      return warning.find("in the order of coverage would come within 1 %") != std::string::npos;
    });
  };
  const Packing& by_radius = packedCup(SphereOrder::radius);
  EXPECT_TRUE(bare(by_radius));
  EXPECT_NE(bareSurface(by_radius, 256), "");
  const Packing& covering = packedCup(SphereOrder::coverage);
  EXPECT_FALSE(bare(covering));
  EXPECT_EQ(bareSurface(covering, 256), "");
}

// Spheres of 0.04 m and more fit into the foot, and not into the walls: their rim is 0.9 m above it.
TEST(Coverage, WhatTheSmallestRadiusLeavesOutIsSaid) {
  PackOptions options;
  options.gap = 0.05;
  options.min_radius = 0.04;
  options.overlap_errors = false;
  const std::string within = "would come within ", asked = "not the 0.05 m that were asked for";
  for (const std::size_t spheres : {0, 20}) {
    options.spheres = spheres;
    std::string warnings;
    for (const std::string& warning : pack(*makeSolid(cupMesh(), "cup"), options).warnings)
      warnings += warning + '\n';
    ASSERT_NE(warnings.find(within), std::string::npos) << warnings;
    EXPECT_NEAR(std::stod(warnings.substr(warnings.find(within) + within.size())), 100 * 0.9 / kDiagonal, 1);
    EXPECT_NE(warnings.find("smallest allowed radius, 0.04 m"), std::string::npos) << warnings;
    EXPECT_EQ(warnings.find(asked) == std::string::npos, spheres > 0)
        << "the number came first: " << warnings;
  }
}

}  // namespace
}  // namespace innersphere::test
