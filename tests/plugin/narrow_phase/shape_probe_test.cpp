// A packing and shapes of Bullet's, probed where the distances of their surfaces are known in closed form.
#include "narrow_phase/shape_probe.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include <btBulletCollisionCommon.h>

#include "test_packings.hpp"

namespace innersphere::test {
namespace {

constexpr double kRounding = 2e-5;
constexpr double kTessellation = 6e-4;  ///< of a ball of 1 m: see singleBall

/// A packing near another shape, and the spheres near it.
struct Near {
  Near(const btCollisionShape& other_shape, std::shared_ptr<PackingShape> packing, const btTransform& place)
      : shape(std::move(packing)),
        a(*shape, place, Estimator::raw, btScalar(0.3)),
        surface(makeShapeSurface(other_shape)) {
    surface->findNearSpheres(a, world, spheres);
  }
  ShapeProbe probe() const { return ShapeProbe(a, *surface, world, spheres); }
  std::size_t indexOf(std::uint32_t sphere) const {
    std::size_t i = 0;
    while (spheres[i].sphere != sphere) ++i;
    return i;
  }

  const btTransform world = btTransform::getIdentity();
  std::shared_ptr<PackingShape> shape;
  PlacedPacking a;
  std::unique_ptr<ShapeSurface> surface;
  std::vector<NearSphere> spheres;
};

std::shared_ptr<PackingShape> withoutMargin(Packing packing) {
  auto shape = makeShape(std::move(packing));
  shape->setMargin(0);
  return shape;
}

TEST(ShapeProbe, FindsTheDepthOfABallInAPlane) {
  const btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  const Near near(plane, withoutMargin(singleBall(1)),
                  btTransform(btQuaternion::getIdentity(), btVector3(2, 3, btScalar(0.97))));
  ASSERT_EQ(near.spheres.size(), 1u);
  ProbedSample sample;
  ASSERT_TRUE(near.probe().probe(sample));
  const btVector3 down(0, 0, -1);
  EXPECT_NEAR(sample.direction.distance(down), 0, 1e-6);
  EXPECT_NEAR(sample.points.depthAlong(down), 0.03, kTessellation);
  EXPECT_NEAR(sample.points.on_b.distance(btVector3(0, 0, btScalar(-0.97))), 0, kRounding);
  EXPECT_NEAR(sample.points.curvature_a, 1, 0.02);
  EXPECT_EQ(sample.points.curvature_b, 0);
  // Beside it the plane goes on, and the ball is higher.
  OpposedPoints points;
  ASSERT_TRUE(near.probe().probeLine(0, down, btVector3(btScalar(0.3), 0, 0), points));
  EXPECT_NEAR(points.depthAlong(down), std::sqrt(1 - 0.09) - 0.97, kTessellation);
}

TEST(ShapeProbe, FindsTheDepthOfTwoBalls) {
  const btSphereShape ball(2);
  const btVector3 direction = btVector3(-2, 1, 2) / 3;  // from A to B
  const Near near(ball, withoutMargin(singleBall(1)),
                  btTransform(btQuaternion::getIdentity(), direction * btScalar(-2.95)));
  ProbedSample sample;
  ASSERT_TRUE(near.probe().probe(sample));
  EXPECT_NEAR(sample.direction.distance(direction), 0, 1e-6);
  EXPECT_NEAR(sample.points.depthAlong(direction), 0.05, kTessellation);
  EXPECT_NEAR(sample.points.curvature_b, 0.5, 1e-6);
  // Beside it the line goes on to where B's ball is nearest from there.
  OpposedPoints points;
  const btVector3 sideways = direction.cross(btVector3(1, 0, 0)).normalized();
  ASSERT_TRUE(near.probe().probeLine(0, direction, sideways * btScalar(0.1), points));
  const btVector3 to_b = direction * btScalar(2.95), from = sideways * btScalar(0.1);
  const btVector3 towards = (to_b - from).normalized();
  EXPECT_NEAR(points.normal_b.distance(towards), 0, 1e-6);
  EXPECT_NEAR(points.on_b.distance(to_b - towards * btScalar(2)), 0, 1e-6);
}

TEST(ShapeProbe, KnowsWhereAFaceEnds) {
  const btBoxShape table(btVector3(1, 1, 1));
  // Over the face, 0.2 m from its edge.
  const Near near(table, withoutMargin(singleBall(0.5)),
                  btTransform(btQuaternion::getIdentity(), btVector3(btScalar(0.8), 0, btScalar(1.49))));
  ASSERT_EQ(near.spheres.size(), 1u);
  const btVector3 down(0, 0, -1);
  OpposedPoints points;
  EXPECT_TRUE(near.probe().probeLine(0, down, btVector3(btScalar(0.15), 0, 0), points));
  EXPECT_NEAR(points.normal_b.distance(down), 0, 1e-6);
  EXPECT_TRUE(near.probe().probeLine(0, down, btVector3(btScalar(-0.25), 0, 0), points));
  EXPECT_NEAR(points.normal_b.distance(down), 0, 1e-6);
  // 0.05 m beyond it and 0.49 m above it, only the edge itself is there.
  EXPECT_TRUE(near.probe().probeLine(0, down, btVector3(btScalar(0.25), 0, 0), points));
  EXPECT_NEAR(points.normal_b.distance(btVector3(btScalar(-0.05), 0, btScalar(-0.49)).normalized()), 0, 1e-6);
}

TEST(ShapeProbe, FindsTheLowestCornerOfACube) {
  const btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  const btQuaternion turn(btVector3(1, btScalar(0.3), 0).normalized(), btScalar(0.6));
  const btMatrix3x3 axes(turn);
  btVector3 corner;
  for (int k = 0; k < 3; ++k) corner[k] = axes[2][k] > 0 ? btScalar(-0.5) : btScalar(0.5);
  const btVector3 lowest = axes * corner;
  const Near near(plane, withoutMargin(latticeBox({1, 1, 1}, 4)),
                  btTransform(turn, btVector3(0, 0, -lowest.z() - btScalar(0.01))));
  std::size_t index = 0;
  for (std::size_t i = 0; i < near.spheres.size(); ++i) {
    if (near.spheres[i].distance < near.spheres[index].distance) index = i;
  }
  const btVector3 down(0, 0, -1);
  OpposedPoints points;
  btVector3 direction;
  ASSERT_TRUE(near.probe().nearest(index, direction, points));
  near.probe().probeLine(index, direction, btVector3(0, 0, 0), points);
  std::vector<std::uint32_t> vertices;
  std::vector<EdgeContact> corners;
  near.probe().corners(index, points, down, true, vertices, corners);
  ASSERT_EQ(corners.size(), 1u);
  EXPECT_NEAR(corners[0].points.on_a.distance(lowest), 0, kRounding);
  EXPECT_NEAR(corners[0].points.depthAlong(down), 0.01, kRounding);
  EXPECT_TRUE(corners[0].is_peak);
  // The plane has none.
  corners.clear();
  near.probe().corners(index, points, down, false, vertices, corners);
  EXPECT_TRUE(corners.empty());
}

/// A slab with its upper face at z = 0, and Bullet's cylinder on it, whose axis leans from x. The slab goes
/// on to x = 1.
class CylinderOnSlab {
 public:
  CylinderOnSlab(double x, double lean)
      : axis(btScalar(std::cos(lean)), 0, btScalar(std::sin(lean))),
        out(btScalar(-std::sin(lean)), 0, btScalar(std::cos(lean))),
        middle_(btScalar(x), btScalar(0.2), btScalar(kRadius)) {}

  std::vector<EdgeContact> lineEnds() const {
    const btVector3 half_extents{btScalar(kHalf), btScalar(kRadius), btScalar(kRadius)};
    btCylinderShapeX cylinder(half_extents);
    cylinder.setMargin(btScalar(kMargin));
    const auto slab = withoutMargin(latticeBox({2, 2, 2}, 4));
    const PlacedPacking a(*slab, btTransform(btQuaternion::getIdentity(), btVector3(0, 0, -1)),
                          Estimator::raw, btScalar(0.3));
    const btTransform place(btQuaternion(btVector3(0, 1, 0), btScalar(-std::atan2(axis.z(), axis.x()))),
                            middle_);
    const auto surface = makeShapeSurface(cylinder);
    std::vector<NearSphere> spheres;
    surface->findNearSpheres(a, place, spheres);
    OpposedPoints points;
    points.on_a.setValue(btScalar(0.1), btScalar(0.1), 1);
    points.normal_a = points.normal_b = btVector3(0, 0, 1);
    points.curvature_b = btScalar(1 / kRadius);
    EXPECT_TRUE(SharpEdges(a, {0, 0, 0}).nearestTriangle(points.on_a, points.triangle_a));
    std::vector<EdgeContact> ends;
    ShapeProbe(a, *surface, place, spheres).lineEnds(points, ends);
    return ends;
  }
  /// Of the lowest line, relative to the slab's middle.
  btVector3 end(int side) const {
    // The line ends where the rounding of the rim begins.
    const btScalar half = btScalar(kHalf - kMargin);
    return middle_ + axis * (side * half) - out * btScalar(kRadius) + btVector3(0, 0, 1);
  }

  static constexpr double kHalf = 0.5, kRadius = 0.3, kMargin = 0.02;
  const btVector3 axis, out;  ///< out of the slab, across the axis

 private:
  const btVector3 middle_;
};

TEST(ShapeProbe, FindsTheEndsOfTheLineInWhichACylinderLies) {
  for (const double lean : {0.0, 0.03, -0.08}) {
    const CylinderOnSlab bodies(-0.1, lean);
    const std::vector<EdgeContact> ends = bodies.lineEnds();
    ASSERT_EQ(ends.size(), 2u) << lean;
    EXPECT_NE(ends[0].id, ends[1].id);
    for (const EdgeContact& end : ends) {
      EXPECT_GE(end.id, kCornerId);
      const btVector3 expected = bodies.end(end.points.on_b.x() < -0.1 ? -1 : 1);
      EXPECT_NEAR(end.points.on_b.distance(expected), 0, kRounding);
      EXPECT_NEAR(end.points.on_a.distance(btVector3(expected.x(), expected.y(), 1)), 0, kRounding);
      EXPECT_NEAR(end.points.normal_a.distance(btVector3(0, 0, 1)), 0, kRounding);
      EXPECT_NEAR(end.points.normal_b.distance(bodies.out), 0, kRounding);
      EXPECT_NEAR(end.points.curvature_b, 1 / CylinderOnSlab::kRadius, kRounding);
      EXPECT_NEAR(std::fabs(end.points.straight_b.dot(bodies.axis)), 1, kRounding);
    }
  }
}

TEST(ShapeProbe, FindsNoEndOfALineThatIsBeyondTheFace) {
  EXPECT_EQ(CylinderOnSlab(0.51, 0).lineEnds().size(), 2u);  // at 0.99 m
  const CylinderOnSlab over_edge(0.53, 0);
  const std::vector<EdgeContact> ends = over_edge.lineEnds();
  ASSERT_EQ(ends.size(), 1u);
  EXPECT_NEAR(ends[0].points.on_b.distance(over_edge.end(-1)), 0, kRounding);
}

TEST(ShapeProbe, FindsNoEndsOfALineThatLeansFromTheFace) {
  EXPECT_TRUE(CylinderOnSlab(-0.1, 0.12).lineEnds().empty());
}

TEST(ShapeProbe, FindsWhereACubesEdgeCrossesThatOfABox) {
  // The cube's lower edge lies along y, the box's upper edge along x.
  const btScalar half = btSqrt(btScalar(0.5));
  btBoxShape box(btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5)));
  box.setMargin(0);
  const btTransform below(btQuaternion(btVector3(1, 0, 0), SIMD_HALF_PI / 2), btVector3(0, 0, -half));
  const btTransform above(btQuaternion(btVector3(0, 1, 0), SIMD_HALF_PI / 2),
                          btVector3(btScalar(0.1), btScalar(0.05), half - btScalar(0.01)));
  const auto cube = withoutMargin(latticeBox({1, 1, 1}, 4));
  const PlacedPacking a(*cube, above, Estimator::raw, btScalar(0.3));
  const auto surface = makeShapeSurface(box);
  std::vector<NearSphere> spheres;
  surface->findNearSpheres(a, below, spheres);
  const ShapeProbe probe(a, *surface, below, spheres);
  const btVector3 down(0, 0, -1);
  int found = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    ProbedSample sample;
    sample.index = i;
    probe.probe(sample);
    EdgeContact crossing;
    if (sample.points.triangle_a == OpposedPoints::kNone || !probe.crossing(sample.points, down, crossing))
      continue;
    ++found;
    EXPECT_NEAR(crossing.points.depthAlong(down), 0.01, 1e-4);
    EXPECT_NEAR(crossing.points.normal_a.distance(down), 0, 1e-4);
    // In the world it is over x = 0.1, y = 0.
    EXPECT_NEAR(crossing.points.on_a.x(), 0, 1e-4);
    EXPECT_NEAR(crossing.points.on_a.y(), -0.05, 1e-4);
    EXPECT_GE(crossing.id, kCrossingId);
    EXPECT_LT(crossing.id, kCornerId);
  }
  EXPECT_GT(found, 0);
}

}  // namespace
}  // namespace innersphere::test
