// Edges of two cubes that cross, against the closest points of two lines in double precision.
#include "narrow_phase/edge_edge.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "test_packings.hpp"

namespace innersphere::test {
namespace {

constexpr double kRounding = 1e-4;
const double kHalfDiagonal = std::sqrt(0.5);
const btVector3 kUp(0, 0, 1);

/// Two cubes of 1 m that stand on edges. The upper edge of A lies along y, at x = 0; the lower edge of B is
/// turned by an angle from the x axis, and as deep in A as `depth`.
class CrossingCubes {
 public:
  CrossingCubes(double angle, const btVector3& shift, double depth)
      : turn_b_(btQuaternion(kUp, btScalar(angle)) * btQuaternion(btVector3(1, 0, 0), SIMD_HALF_PI / 2)),
        place_b_(shift.x(), shift.y(), btScalar(2 * kHalfDiagonal - depth)) {
    cube_->setMargin(0);
  }
  PlacedPacking a() const {
    return PlacedPacking(*cube_,
                         btTransform(btQuaternion(btVector3(0, 1, 0), SIMD_HALF_PI / 2), btVector3(0, 0, 0)),
                         Estimator::raw, 0);
  }
  PlacedPacking b() const { return PlacedPacking(*cube_, btTransform(turn_b_, place_b_), Estimator::raw, 0); }
  PackingShape& shape() { return *cube_; }

  /// On faces beside the edges, `aside` from the crossing.
  bool find(double aside_a, double aside_b, EdgeContact& crossing) const {
    const PlacedPacking placed_a = a(), placed_b = b();
    const SharpEdges edges_a(placed_a, btVector3(0, 0, 0)), edges_b(placed_b, place_b_);
    const btVector3 along_b = btTransform(turn_b_).getBasis().getColumn(0);
    const btVector3 beside_b = kUp.cross(along_b);
    const btVector3 near_a(btScalar(aside_a), 0, btScalar(kHalfDiagonal - std::fabs(aside_a)));
    const btVector3 near_b =
        place_b_ + beside_b * btScalar(aside_b) - kUp * btScalar(kHalfDiagonal - std::fabs(aside_b));
    OpposedPoints points;
    points.on_a = near_a;
    points.on_b = near_b;
    EXPECT_TRUE(edges_a.nearestTriangle(near_a, points.triangle_a));
    EXPECT_TRUE(edges_b.nearestTriangle(near_b, points.triangle_b));
    points.normal_a = edges_a.face(points.triangle_a);
    points.normal_b = -edges_b.face(points.triangle_b);
    return crossEdges(edges_a, edges_b, points, kUp, crossing);
  }

 private:
  std::shared_ptr<PackingShape> cube_ = makeShape(latticeBox({1, 1, 1}, 2));
  btQuaternion turn_b_;
  btVector3 place_b_;
};

TEST(CrossEdges, FindsWhereTheyCross) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> angles(-1, 1), shifts(-0.2, 0.2), depths(-0.02, 0.05);
  for (int i = 0; i < 100; ++i) {
    const double angle = angles(rng), depth = depths(rng);
    const btVector3 shift(btScalar(shifts(rng)), btScalar(shifts(rng)), 0);
    const CrossingCubes cubes(angle, shift, depth);
    EdgeContact crossing;
    ASSERT_TRUE(cubes.find(i % 2 ? 0.05 : -0.05, i % 4 < 2 ? 0.05 : -0.05, crossing)) << i;
    // B's edge leads through its lowest point in the direction of the angle; A's is x = 0.
    const double y = shift.y() - shift.x() * std::tan(angle);
    const btVector3 on_a(0, btScalar(y), btScalar(kHalfDiagonal));
    EXPECT_NEAR(crossing.points.on_a.distance(on_a), 0, kRounding);
    EXPECT_NEAR(crossing.points.on_b.distance(on_a - kUp * btScalar(depth)), 0, kRounding);
    EXPECT_NEAR(crossing.points.normal_a.distance(kUp), 0, kRounding);
    EXPECT_NEAR(crossing.points.normal_b.distance(kUp), 0, kRounding);
  }
}

TEST(CrossEdges, GivesTheSameIdFromAllSides) {
  const CrossingCubes cubes(0.3, btVector3(btScalar(0.1), btScalar(0.05), 0), 0.01);
  EdgeContact first;
  ASSERT_TRUE(cubes.find(0.05, 0.05, first));
  EXPECT_GE(first.id, kCrossingId);
  EXPECT_LT(first.id, kCornerId);
  for (const double a : {0.05, -0.05, 0.15}) {
    for (const double b : {0.05, -0.05, -0.1}) {
      EdgeContact crossing;
      ASSERT_TRUE(cubes.find(a, b, crossing));
      EXPECT_EQ(crossing.id, first.id);
    }
  }
}

TEST(CrossEdges, AddsTheMargins) {
  CrossingCubes cubes(0.3, btVector3(0, 0, 0), 0.01);
  cubes.shape().setMargin(btScalar(0.02));
  EdgeContact crossing;
  ASSERT_TRUE(cubes.find(0.05, 0.05, crossing));
  EXPECT_NEAR(crossing.points.depthAlong(kUp), 0.05, kRounding);
}

TEST(CrossEdges, FindsNoneWhereTheyAreParallel) {
  const CrossingCubes cubes(M_PI / 2 - 0.05, btVector3(0, 0, 0), 0.01);
  EdgeContact crossing;
  EXPECT_FALSE(cubes.find(0.05, 0.05, crossing));
}

TEST(CrossEdges, FindsNoneBeyondTheirEnds) {
  // B's edge ends before it reaches A's.
  const CrossingCubes cubes(0, btVector3(btScalar(0.6), 0, 0), 0.01);
  EdgeContact crossing;
  EXPECT_FALSE(cubes.find(0.05, 0.05, crossing));
}

TEST(CrossEdges, FindsNoneWhereTheyHavePassedEachOther) {
  // So deep that the places between the edges are on the far sides of both cubes.
  const CrossingCubes cubes(0.2, btVector3(0, 0, 0), 3);
  EdgeContact crossing;
  EXPECT_FALSE(cubes.find(0.05, 0.05, crossing));
}

}  // namespace
}  // namespace innersphere::test
