// The flat faces of hulls and meshes, with the edges between them.
#include "narrow_phase/shapes/facets.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include <btBulletCollisionCommon.h>

namespace innersphere::test {
namespace {

constexpr double kRounding = 1e-5;
const btTransform kPlace(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(0.7)), btVector3(7, 8, 9));
const btVector3 kRelativeTo(5, 5, 5);

btVector3 toSolid(const btVector3& local) {
  return kPlace(local) - kRelativeTo;
}

TEST(Facets, OfABoxAreItsFaces) {
  btBoxShape box(btVector3(1, 2, 3));
  box.setMargin(btScalar(0.01));
  Facets facets;
  facets.setHull(box);
  SharpEdges solid;
  ASSERT_TRUE(facets.place(kPlace, kRelativeTo, solid));
  const double half[] = {1, 2, 3};
  for (int axis = 0; axis < 3; ++axis) {
    btVector3 outside(btScalar(0.1), btScalar(0.2), btScalar(-0.3));
    outside[axis] = btScalar(half[axis] + 0.5);
    std::size_t triangle = 0;
    ASSERT_TRUE(solid.nearestTriangle(toSolid(outside), triangle));
    EXPECT_NEAR(solid.face(triangle).distance(kPlace.getBasis().getColumn(axis)), 0, kRounding);
    btScalar distance = 0;
    ASSERT_TRUE(solid.distanceOf(toSolid(outside), distance));
    // Bullet counts the margin of a box as part of it.
    EXPECT_NEAR(distance - solid.margin, 0.5, kRounding);
  }
  EXPECT_TRUE(solid.isIn(toSolid(btVector3(0, 0, 0)), 10));
  EXPECT_FALSE(solid.isIn(toSolid(btVector3(2, 0, 0)), 10));
}

TEST(Facets, OfAHullAreSmallerByItsMargin) {
  btConvexHullShape hull;
  for (int i = 0; i < 8; ++i)
    hull.addPoint(btVector3(btScalar(i & 1 ? 1 : -1), btScalar(i & 2 ? 1 : -1), btScalar(i & 4 ? 1 : -1)));
  hull.setMargin(btScalar(0.05));
  Facets facets;
  facets.setHull(hull);
  SharpEdges solid;
  ASSERT_TRUE(facets.place(kPlace, kRelativeTo, solid));
  EXPECT_NEAR(solid.margin, 0.05, kRounding);
  btScalar distance = 0;
  ASSERT_TRUE(solid.distanceOf(toSolid(btVector3(0, 0, 2)), distance));
  EXPECT_NEAR(distance, 1, kRounding);
  // An edge between two of its faces is straight and as long as the cube.
  std::size_t triangle = 0;
  SharpEdges::Edge edge;
  const btVector3 on_top(btScalar(0.2), btScalar(0.1), 1);
  ASSERT_TRUE(solid.nearestTriangle(toSolid(on_top), triangle));
  ASSERT_TRUE(solid.edgeTowards(triangle, toSolid(on_top), kPlace.getBasis().getColumn(0), edge));
  EXPECT_NEAR(edge.along.length(), 2, kRounding);
  EXPECT_NEAR(std::fabs(edge.along.normalized().dot(kPlace.getBasis().getColumn(1))), 1, kRounding);
}

TEST(Facets, OfALargeHullAreSeenUprightFromCloseBy) {
  const btVector3 half(3, 3, btScalar(0.015));
  btConvexHullShape hull;
  for (int i = 0; i < 8; ++i)
    hull.addPoint(half *
                  btVector3(btScalar(i & 1 ? 1 : -1), btScalar(i & 2 ? 1 : -1), btScalar(i & 4 ? 1 : -1)));
  hull.setMargin(0);
  Facets facets;
  facets.setHull(hull);
  const int count = 40;
  for (const double height : {-5e-3, -1e-4, -1e-5, 1e-5, 1e-4, 5e-3}) {
    for (int i = 0; i < count * count; ++i) {
      const double x = 5.9 * ((i % count + 0.37) / count - 0.5), y = 5.9 * ((i / count + 0.59) / count - 0.5);
      for (const btScalar side : {btScalar(-1), btScalar(1)}) {
        Facets::Nearest nearest;
        const btVector3 place(btScalar(x), btScalar(y), side * (half.z() + btScalar(height)));
        ASSERT_TRUE(facets.nearest(place, nearest));
        ASSERT_NEAR(nearest.distance, height, 1e-6) << x << " " << y << " " << height;
        ASSERT_NEAR(nearest.normal.distance(btVector3(0, 0, side)), 0, 1e-6)
            << x << " " << y << " " << height;
        ASSERT_EQ(nearest.edge_curvature, 0) << x << " " << y << " " << height;
      }
    }
  }
  // Beside an edge it is seen.
  for (const double distance : {1e-3, 1e-1}) {
    Facets::Nearest nearest;
    const double d = distance / std::sqrt(2.0);
    ASSERT_TRUE(facets.nearest(half + btVector3(btScalar(d), -1, btScalar(d)), nearest));
    EXPECT_NEAR(nearest.distance, distance, 1e-6);
    EXPECT_NEAR(nearest.normal.distance(btVector3(1, 0, 1).normalized()), 0, 1e-2);
    EXPECT_GT(nearest.edge_curvature, 0);
    EXPECT_NEAR(std::fabs(nearest.along.y()), 1, 1e-6);
  }
}

class RoofMesh : public testing::Test {
 protected:
  /// Two sloped rectangles that meet in the ridge x = 0, z = 1.
  RoofMesh() {
    const btVector3 ridge[] = {{0, -2, 1}, {0, 2, 1}};
    for (const btScalar side : {btScalar(1), btScalar(-1)}) {
      const btVector3 eaves[] = {{side, -2, 0}, {side, 2, 0}};
      mesh_.addTriangle(ridge[0], eaves[0], ridge[1]);
      mesh_.addTriangle(ridge[1], eaves[0], eaves[1]);
    }
    shape_ = std::make_unique<btBvhTriangleMeshShape>(&mesh_, true);
  }
  btTriangleMesh mesh_;
  std::unique_ptr<btBvhTriangleMeshShape> shape_;
};

TEST_F(RoofMesh, HasOneEdgeWhereItsTrianglesMeet) {
  Facets facets;
  facets.setMesh(*shape_, btVector3(-3, -3, -1), btVector3(3, 3, 2));
  SharpEdges solid;
  ASSERT_TRUE(facets.place(kPlace, kRelativeTo, solid));
  std::size_t triangle = 0;
  const btVector3 on_roof(btScalar(0.4), btScalar(0.3), btScalar(0.6));
  ASSERT_TRUE(solid.nearestTriangle(toSolid(on_roof), triangle));
  SharpEdges::Edge edge;
  const btVector3 uphill = kPlace.getBasis() * btVector3(-1, 0, 1).normalized();
  ASSERT_TRUE(solid.edgeTowards(triangle, toSolid(on_roof), uphill, edge));
  EXPECT_NEAR(edge.along.length(), 4, kRounding);
  EXPECT_NEAR(
      edge.from.distance(toSolid(btVector3(0, -2, 1))) * edge.from.distance(toSolid(btVector3(0, 2, 1))), 0,
      1e-4);
  // At the eaves it ends: no face lies beyond.
  EXPECT_FALSE(solid.edgeTowards(triangle, toSolid(on_roof), -uphill, edge));
  EXPECT_EQ(solid.margin, 0);
}

TEST_F(RoofMesh, HasNoFacesWhereThereAreNone) {
  Facets facets;
  EXPECT_TRUE(facets.isExpired());
  facets.setMesh(*shape_, btVector3(10, 10, 10), btVector3(11, 11, 11));
  EXPECT_FALSE(facets.isExpired());
  SharpEdges solid;
  EXPECT_FALSE(facets.place(kPlace, kRelativeTo, solid));
  facets.expire();
  EXPECT_TRUE(facets.isExpired());
}

}  // namespace
}  // namespace innersphere::test
