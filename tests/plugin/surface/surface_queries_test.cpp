// Searches on a surface against what is known of a box in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "surface/surface_queries.hpp"
#include "surface/vertex_hill_climb.hpp"
#include "test_packings.hpp"

namespace innersphere::test {
namespace {

const Vec3d kSize{1, 2, 3};

/// Signed distance of a point from the box, and the direction out of it.
double boxDistance(const btVector3& p, double normal[3]) {
  double outside[3], length2 = 0, deepest = -1e9;
  int axis = 0;
  for (int k = 0; k < 3; ++k) {
    const double beyond = std::fabs(p[k]) - kSize[k] / 2;
    outside[k] = std::max(beyond, 0.0);
    length2 += outside[k] * outside[k];
    if (beyond > deepest) {
      deepest = beyond;
      axis = k;
    }
  }
  for (int k = 0; k < 3; ++k) {
    const double part = length2 > 0 ? outside[k] / std::sqrt(length2) : (k == axis ? 1.0 : 0.0);
    normal[k] = p[k] < 0 ? -part : part;
  }
  return length2 > 0 ? std::sqrt(length2) : deepest;
}

TEST(SurfaceQueries, IsTheDistanceOfABox) {
  const Packing box = latticeBox(kSize, 1);
  const SurfaceQueries tree(box.surface);
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> uniform(-2, 2);
  for (int i = 0; i < 2000; ++i) {
    const btVector3 p{btScalar(uniform(rng)), btScalar(uniform(rng)), btScalar(uniform(rng))};
    double normal[3];
    const double distance = boxDistance(p, normal);
    if (std::fabs(distance) < 1e-3) continue;  // too near for a direction
    SurfaceQueries::Nearest found;
    ASSERT_TRUE(tree.nearest(p, 10, found));
    EXPECT_NEAR(found.distance, distance, 1e-5);
    // Inside there are places between two faces; there any of the two will do.
    const btVector3 foot = p - found.normal * found.distance;
    double at_foot[3];
    EXPECT_NEAR(boxDistance(foot, at_foot), 0, 1e-4);
    if (distance > 0) {
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(found.normal[k], normal[k], 1e-3);
    }
  }
}

TEST(SurfaceQueries, LooksNoFurtherThanItsReach) {
  const Packing box = latticeBox(kSize, 1);
  const SurfaceQueries tree(box.surface);
  SurfaceQueries::Nearest found;
  EXPECT_FALSE(tree.nearest(btVector3(btScalar(0.8), 0, 0), btScalar(0.29), found));
  EXPECT_TRUE(tree.nearest(btVector3(btScalar(0.8), 0, 0), btScalar(0.31), found));
}

TEST(VertexHillClimb, FindsTheHighestVertexOfAConvexSolid) {
  const Packing box = latticeBox(kSize, 1);
  const VertexHillClimb climb(box.surface);
  std::mt19937 rng(6);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 200; ++i) {
    const btVector3 direction =
        btVector3{btScalar(normal(rng)), btScalar(normal(rng)), btScalar(normal(rng))}.normalized();
    const auto height = [&](const std::array<float, 3>& v) {
      return v[0] * direction.x() + v[1] * direction.y() + v[2] * direction.z();
    };
    btScalar highest = -10;
    for (const auto& v : box.surface.vertices) highest = std::max<btScalar>(highest, height(v));
    std::vector<std::uint32_t> found;
    climb.from(rng() % box.surface.triangles.size(), direction, btVector3(0, 0, 0), 10, found);
    ASSERT_FALSE(found.empty());
    EXPECT_NEAR(height(box.surface.vertices[found[0]]), highest, 1e-6);
  }
}

TEST(VertexHillClimb, StaysNear) {
  const Packing ball = singleBall(1);
  const VertexHillClimb climb(ball.surface);
  const auto& start = ball.surface.vertices[ball.surface.triangles[1000][0]];
  std::vector<std::uint32_t> found;
  const btVector3 at(start[0], start[1], start[2]);
  climb.from(1000, btVector3(1, 0, 0), at, btScalar(0.2), found);
  ASSERT_FALSE(found.empty());
  const auto& top = ball.surface.vertices[found[0]];
  EXPECT_LT(btVector3(top[0], top[1], top[2]).distance(at), 0.2);
  found.clear();
  climb.from(1000, btVector3(1, 0, 0), btVector3(9, 9, 9), btScalar(0.2), found);
  EXPECT_TRUE(found.empty());
}

TEST(VertexHillClimb, BringsBothEndsOfALevelEdge) {
  const Packing box = latticeBox({1, 1, 1}, 1);
  const VertexHillClimb climb(box.surface);
  const btVector3 down = btVector3(0, -1, -1).normalized();
  for (std::size_t t = 0; t < box.surface.triangles.size(); ++t) {
    std::vector<std::uint32_t> found;
    climb.from(t, down, btVector3(0, 0, 0), 10, found);
    btScalar left = 1, right = -1;
    for (std::uint32_t v : found) {
      const auto& p = box.surface.vertices[v];
      EXPECT_NEAR(p[1], -0.5, 1e-6);
      EXPECT_NEAR(p[2], -0.5, 1e-6);
      left = std::min<btScalar>(left, p[0]);
      right = std::max<btScalar>(right, p[0]);
    }
    EXPECT_NEAR(left, -0.5, 1e-6);
    EXPECT_NEAR(right, 0.5, 1e-6);
  }
}

}  // namespace
}  // namespace innersphere::test
