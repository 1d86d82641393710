// The edges of a box, turned, moved and scaled, and its faces.
#include "shape/sharp_edges.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "test_packings.hpp"

namespace innersphere::test {
namespace {

constexpr double kRounding = 2e-5, kScale = 2;
const Vec3d kHalf{0.5, 1, 1.5};  ///< of the box in the world

class BoxEdges : public testing::Test {
 protected:
  BoxEdges() { shape->setLocalScaling(btVector3(btScalar(kScale), btScalar(kScale), btScalar(kScale))); }

  SharpEdges edges() const { return SharpEdges(body(), at); }
  PlacedPacking body() const { return PlacedPacking(*shape, world, Estimator::raw, 0); }
  btVector3 toWorld(const btVector3& local) const { return at + world.getBasis() * local; }

  const std::shared_ptr<PackingShape> shape = makeShape(latticeBox({kHalf[0], kHalf[1], kHalf[2]}, 2));
  const btTransform world{btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(0.7)), btVector3(7, 8, 9)};
  const btVector3 at{btScalar(0.3), btScalar(-0.2), btScalar(0.1)};  ///< relative to some other packing
};

TEST_F(BoxEdges, AreMetInTheDirectionThatIsAsked) {
  const SharpEdges solid = edges();
  std::mt19937 rng(2);
  std::uniform_real_distribution<double> u(-0.9, 0.9);
  for (int i = 0; i < 100; ++i) {
    // On the face x = half, towards one of its four edges.
    const btVector3 local(btScalar(kHalf[0]), btScalar(u(rng) * kHalf[1]), btScalar(u(rng) * kHalf[2]));
    const int axis = 1 + i % 2, along = 3 - axis;
    const double sign = i % 4 < 2 ? 1 : -1;
    btVector3 way(0, 0, 0);
    way[axis] = btScalar(sign);
    std::size_t triangle = 0;
    ASSERT_TRUE(solid.nearestTriangle(toWorld(local), triangle));
    SharpEdges::Edge edge;
    ASSERT_TRUE(solid.edgeTowards(triangle, toWorld(local), world.getBasis() * way, edge));
    EXPECT_NEAR(edge.along.length(), 2 * kHalf[std::size_t(along)], kRounding);
    EXPECT_NEAR(std::fabs(edge.along.normalized().dot(world.getBasis().getColumn(along))), 1, 1e-5);
    btVector3 foot = local;
    foot[axis] = btScalar(sign * kHalf[std::size_t(axis)]);
    const btVector3 offset = toWorld(foot) - edge.from;
    const btVector3 line = edge.along.normalized();
    EXPECT_NEAR((offset - line * offset.dot(line)).length(), 0, kRounding);
    // Along both of its faces: back on this one, and down the next.
    const btVector3 back = world.getBasis() * -way, down = -world.getBasis().getColumn(0);
    const SharpEdges::Faces faces = solid.facesOf(edge);
    EXPECT_NEAR(std::min(faces.inwards[0].distance(back), faces.inwards[1].distance(back)), 0, 1e-5);
    EXPECT_NEAR(std::min(faces.inwards[0].distance(down), faces.inwards[1].distance(down)), 0, 1e-5);
  }
}

TEST_F(BoxEdges, HaveTheSameIdFromBothFaces) {
  const SharpEdges solid = edges();
  const btVector3 on_x(btScalar(kHalf[0]), 0, btScalar(0.1)), on_y(0, btScalar(kHalf[1]), btScalar(0.1));
  std::size_t triangle = 0;
  SharpEdges::Edge from_x, from_y, other;
  ASSERT_TRUE(solid.nearestTriangle(toWorld(on_x), triangle));
  ASSERT_TRUE(solid.edgeTowards(triangle, toWorld(on_x), world.getBasis().getColumn(1), from_x));
  ASSERT_TRUE(solid.edgeTowards(triangle, toWorld(on_x), -world.getBasis().getColumn(1), other));
  ASSERT_TRUE(solid.nearestTriangle(toWorld(on_y), triangle));
  ASSERT_TRUE(solid.edgeTowards(triangle, toWorld(on_y), world.getBasis().getColumn(0), from_y));
  EXPECT_EQ(solid.facesOf(from_x).id, solid.facesOf(from_y).id);
  EXPECT_NE(solid.facesOf(from_x).id, solid.facesOf(other).id);
}

TEST_F(BoxEdges, KnowTheirFaces) {
  const SharpEdges solid = edges();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      btVector3 local(btScalar(0.01), btScalar(0.02), btScalar(0.03));
      local[axis] = btScalar(sign * kHalf[std::size_t(axis)]);
      std::size_t triangle = 0;
      ASSERT_TRUE(solid.nearestTriangle(toWorld(local), triangle));
      const btVector3 normal = world.getBasis().getColumn(axis) * btScalar(sign);
      EXPECT_NEAR(solid.face(triangle).distance(normal), 0, 1e-5);
      EXPECT_NEAR((solid.middle(triangle) - at).dot(normal), kHalf[std::size_t(axis)], kRounding);
    }
  }
}

TEST_F(BoxEdges, TellInsideFromOutsideAndHowFar) {
  SharpEdges solid = edges();
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> u(-2, 2);
  for (int i = 0; i < 500; ++i) {
    const btVector3 local{btScalar(u(rng)), btScalar(u(rng)), btScalar(u(rng))};
    double outside2 = 0, deepest = -1e9;
    for (int k = 0; k < 3; ++k) {
      const double beyond = std::fabs(local[k]) - kHalf[std::size_t(k)];
      outside2 += std::max(beyond, 0.0) * std::max(beyond, 0.0);
      deepest = std::max(deepest, beyond);
    }
    const double expected = outside2 > 0 ? std::sqrt(outside2) : -deepest;
    if (expected < 1e-3) continue;
    btScalar distance = 0;
    ASSERT_TRUE(solid.distanceOf(toWorld(local), distance));
    EXPECT_NEAR(distance, expected, kRounding);
    const bool inside = outside2 == 0;
    EXPECT_EQ(solid.isIn(toWorld(local), btScalar(expected + 0.1)), inside);
    // Too far away to tell.
    EXPECT_FALSE(solid.isIn(toWorld(local), btScalar(expected - 0.01 * expected - 1e-4)));
    solid.inside_out = true;
    EXPECT_EQ(solid.isIn(toWorld(local), btScalar(expected + 0.1)), !inside);
    solid.inside_out = false;
  }
}

TEST(SharpEdgesOfABall, AreNone) {
  const auto ball = makeShape(singleBall(1));
  const PlacedPacking body(*ball, btTransform::getIdentity(), Estimator::raw, 0);
  const SharpEdges solid(body, btVector3(0, 0, 0));
  std::size_t triangle = 0;
  ASSERT_TRUE(solid.nearestTriangle(btVector3(1, 0, 0), triangle));
  SharpEdges::Edge edge;
  EXPECT_FALSE(solid.edgeTowards(triangle, btVector3(1, 0, 0), btVector3(0, 0, 1), edge));
}

}  // namespace
}  // namespace innersphere::test
