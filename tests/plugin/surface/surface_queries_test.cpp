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

/// A ball of radius 1 with hills and hollows, of some thousand triangles.
Surface wavyBall() {
  Surface surface = singleBall(1).surface;
  for (auto& v : surface.vertices) {
    const float size = 1 + 0.2F * std::sin(7 * v[0]) * std::sin(5 * v[1]) * std::cos(6 * v[2]);
    for (float& x : v) x *= size;
  }
  return surface;
}

struct Corners {
  Corners(const Surface& surface, std::size_t triangle) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& v = surface.vertices[surface.triangles[triangle][k]];
      at[k] = {v[0], v[1], v[2]};
    }
    normal = cross(at[1] - at[0], at[2] - at[0]);
  }
  /// The weight of corner k at a place of the plane: it is 0 on the edge across.
  double weight(const Vec3d& place, int k) const {
    const Vec3d from = place - at[(k + 1) % 3], edge = at[(k + 2) % 3] - at[(k + 1) % 3];
    return dot(cross(edge, from), normal) / dot(normal, normal);
  }
  double least(const Vec3d& place) const {
    return std::min({weight(place, 0), weight(place, 1), weight(place, 2)});
  }
  double distance(const Vec3d& from) const {
    const double height = dot(from - at[0], normal) / norm(normal);
    if (least(from) > 0) return std::fabs(height);
    double nearest = 1e9;
    for (int k = 0; k < 3; ++k) {
      const Vec3d edge = at[(k + 1) % 3] - at[k];
      const double along = std::clamp(dot(from - at[k], edge) / dot(edge, edge), 0.0, 1.0);
      nearest = std::min(nearest, norm(from - at[k] - along * edge));
    }
    return nearest;
  }
  Vec3d at[3], normal;
};

btVector3 toBullet(const Vec3d& v) {
  return {btScalar(v.x), btScalar(v.y), btScalar(v.z)};
}

TEST(SurfaceQueries, FindsTheNearestOfAllTriangles) {
  const Surface surface = wavyBall();
  const SurfaceQueries tree(surface);
  std::mt19937 rng(7);
  std::uniform_real_distribution<float> uniform(-1.3F, 1.3F);
  for (int i = 0; i < 500; ++i) {
    const Vec3d p{uniform(rng), uniform(rng), uniform(rng)};
    double nearest = 1e9;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
      nearest = std::min(nearest, Corners(surface, t).distance(p));
    SurfaceQueries::Nearest found;
    ASSERT_TRUE(tree.nearest(toBullet(p), 10, found));
    EXPECT_NEAR(std::fabs(found.distance), nearest, 1e-5);
    EXPECT_NEAR(Corners(surface, found.triangle).distance(p), nearest, 1e-5);
  }
}

TEST(SurfaceQueries, FindsTheFirstOfAllTrianglesOnARay) {
  const Surface surface = wavyBall();
  const SurfaceQueries tree(surface);
  std::mt19937 rng(8);
  std::uniform_real_distribution<float> uniform(-1, 1);
  int met = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3d from{1.3 * uniform(rng), 1.3 * uniform(rng), 1.3 * uniform(rng)};
    const btVector3 direction = toBullet({uniform(rng), uniform(rng), uniform(rng)}).normalized();
    const Vec3d way{direction.x(), direction.y(), direction.z()};
    constexpr double kLength = 1.5, kEdge = 1e-3;
    double first = 1e9;
    bool is_clear = true;  // no edge is met, and the line does not end on the surface
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      const Corners corners(surface, t);
      const double distance = dot(corners.at[0] - from, corners.normal) / dot(way, corners.normal);
      const double inside = corners.least(from + distance * way);
      if (inside > -kEdge && std::fabs(distance) < 2 * kLength) {
        is_clear = is_clear && inside > kEdge && std::fabs(distance) > kEdge &&
                   std::fabs(distance - kLength) > kEdge;
        if (distance > 0) first = std::min(first, distance);
      }
    }
    if (!is_clear) continue;
    SurfaceQueries::Hit hit;
    const bool found = tree.cast(toBullet(from), direction, btScalar(kLength), direction, hit);
    ASSERT_EQ(found, first < kLength) << i;
    if (!found) continue;
    ++met;
    const Corners corners(surface, hit.triangle);
    EXPECT_NEAR(dot(corners.at[0] - from, corners.normal) / dot(way, corners.normal), first, 1e-4) << i;
  }
  EXPECT_GT(met, 300);
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

TEST(SurfaceQueries, TellsHowThickABoxIs) {
  const Packing box = latticeBox(kSize, 1);
  const SurfaceQueries surface(box.surface);
  std::mt19937 rng(6);
  std::uniform_real_distribution<double> uniform(-0.499, 0.499);
  for (int i = 0; i < 300; ++i) {
    btVector3 place, normal(0, 0, 0);
    for (int k = 0; k < 3; ++k) place[k] = btScalar(uniform(rng) * kSize[std::size_t(k)]);
    const int side = i % 3, sign = i % 2 == 0 ? 1 : -1;
    normal[side] = btScalar(sign);
    place[side] = btScalar(sign * kSize[std::size_t(side)] / 2);
    EXPECT_TRUE(surface.isThinner(btScalar(1.01 * kSize[std::size_t(side)]), place, normal));
    EXPECT_FALSE(surface.isThinner(btScalar(0.99 * kSize[std::size_t(side)]), place, normal));
    // Across an edge the other face does not look the other way.
    btVector3 askew = normal;
    askew[(side + 1) % 3] = place[(side + 1) % 3] > 0 ? btScalar(2) : btScalar(-2);
    EXPECT_FALSE(surface.isThinner(btScalar(0.5), place, askew.normalized()));
  }
}

/// Whatever was asked of its triangle before.
TEST(SurfaceQueries, TellsHowThickItIsBelowATriangle) {
  std::mt19937 rng(9);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const Surface& surface : {latticeBox(kSize, 1).surface, wavyBall()}) {
    const SurfaceQueries queries(surface);
    int thinner = 0, thicker = 0;
    for (int i = 0; i < 20000; ++i) {
      const std::size_t t = rng() % std::min<std::size_t>(surface.triangles.size(), 500);
      const Corners corners(surface, t);
      double u = uniform(rng), v = uniform(rng);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const btVector3 at =
          toBullet(corners.at[0] + u * (corners.at[1] - corners.at[0]) + v * (corners.at[2] - corners.at[0]));
      btVector3 normal = queries.normals().face(t);
      if (i % 5 == 0)
        normal = (normal + btVector3(btScalar(uniform(rng)), btScalar(uniform(rng)), 0) / 5).normalized();
      const auto thickness = btScalar(2.5 * uniform(rng));
      const bool expected = queries.isThinner(thickness, at, normal);
      ASSERT_EQ(queries.isThinner(thickness, t, at, normal), expected) << i;
      ++(expected ? thinner : thicker);
    }
    EXPECT_GT(thinner, 500);
    EXPECT_GT(thicker, 500);
  }
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
