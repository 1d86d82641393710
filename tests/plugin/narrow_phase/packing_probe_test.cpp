// Two packings, probed where the distances of their surfaces are known in closed form.
#include "narrow_phase/packing_probe.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "test_packings.hpp"

namespace innersphere::test {
namespace {

constexpr double kRounding = 2e-5;
/// Balls of 1 m and 0.5 m are cut into triangles of at most 0.07 of their radius.
constexpr double kTessellation = 6e-4;

btTransform at(const btVector3& place, const btQuaternion& turn = btQuaternion::getIdentity()) {
  return btTransform(turn, place);
}

SphereContact contactOf(std::uint32_t sphere) {
  SphereContact contact;
  contact.sphere = sphere;
  return contact;
}

/// A ball of 1 m at the place of A, one of 0.5 m in a direction from there. Contact 0 is that of A's sphere.
class Balls : public testing::Test {
 protected:
  static constexpr double kRadiusA = 1, kRadiusB = 0.5, kDepth = 0.02;

  Balls() {
    a->setMargin(0);
    b->setMargin(0);
  }
  PackingProbe probe() const { return PackingProbe(placed_a, placed_b, contacts, 1); }

  const btVector3 direction = btVector3(1, -2, 2) / 3;
  const btVector3 origin{4, 5, btScalar(-6)};
  const std::shared_ptr<PackingShape> a = makeShape(singleBall(kRadiusA)),
                                      b = makeShape(singleBall(kRadiusB));
  const std::vector<SphereContact> contacts{contactOf(0), contactOf(0)};
  const PlacedPacking placed_a{*a, at(origin), Estimator::raw, btScalar(0.1)};
  const PlacedPacking placed_b{*b, at(origin + direction * btScalar(kRadiusA + kRadiusB - kDepth)),
                               Estimator::raw, btScalar(0.1)};
};

TEST_F(Balls, AreProbedOnTheLineOfTheirCentres) {
  for (const std::size_t index : {0u, 1u}) {
    OpposedPoints points;
    btVector3 found;
    ASSERT_TRUE(probe().nearest(index, found, points));
    // The nearest point is anywhere on a triangle of 0.07 radii.
    const double aside = 0.07 * (index == 0 ? kRadiusB : kRadiusA);
    const double distance = (index == 0 ? kRadiusA : kRadiusB) - kDepth;
    EXPECT_LT(found.distance(direction), aside / distance);
    ASSERT_TRUE(probe().probeLine(index, direction, btVector3(0, 0, 0), points));
    EXPECT_NEAR(points.depthAlong(direction), kDepth, kTessellation);
    EXPECT_NEAR(points.on_a.distance(direction * btScalar(kRadiusA)), 0, kTessellation);
    EXPECT_NEAR(points.on_b.distance(direction * btScalar(kRadiusA - kDepth)), 0, kTessellation);
    EXPECT_NEAR(points.normal_a.distance(direction), 0, 4e-3);
    EXPECT_NEAR(points.normal_b.distance(direction), 0, 4e-3);
    EXPECT_NEAR(points.curvature_a, 1 / kRadiusA, 0.02 / kRadiusA);
    EXPECT_NEAR(points.curvature_b, 1 / kRadiusB, 0.02 / kRadiusB);
  }
}

TEST_F(Balls, AreLessDeepBesideIt) {
  const btVector3 sideways = btVector3(2, 2, 1) / 3;
  for (const double shift : {0.05, 0.1, 0.2}) {
    for (const std::size_t index : {0u, 1u}) {
      OpposedPoints points;
      ASSERT_TRUE(probe().probeLine(index, direction, sideways * btScalar(shift), points));
      const double up_a = std::sqrt(kRadiusA * kRadiusA - shift * shift);
      const double up_b = kRadiusA + kRadiusB - kDepth - std::sqrt(kRadiusB * kRadiusB - shift * shift);
      EXPECT_NEAR(points.depthAlong(direction), up_a - up_b, 2 * kTessellation);
      EXPECT_NEAR(points.on_a.dot(sideways), shift, kRounding);
      EXPECT_NEAR(points.normal_a.dot(sideways), shift / kRadiusA, 4e-3);
      EXPECT_NEAR(points.normal_b.dot(sideways), -shift / kRadiusB, 4e-3);
    }
  }
  // Further than the sphere and its margin there is no telling.
  OpposedPoints points;
  EXPECT_FALSE(probe().probeLine(1, direction, sideways * btScalar(0.61), points));
}

TEST_F(Balls, AreFoundFromTheDirectionOfThePatch) {
  // 20 degrees off: the line is drawn again along the normal.
  const btVector3 off = (direction + btVector3(2, 2, 1) / 3 * btScalar(0.36)).normalized();
  for (const std::size_t index : {0u, 1u}) {
    ProbedSample sample;
    sample.index = index;
    ASSERT_TRUE(probe().probe(off, btScalar(0.1), sample));
    EXPECT_NEAR(sample.direction.distance(direction), 0, 1e-2);
    EXPECT_NEAR(sample.points.depthAlong(sample.direction), kDepth, kTessellation);
    ProbedSample again;
    again.index = index;
    const Samples::Line line{sample.direction, sample.points.triangle_a, sample.points.triangle_b};
    ASSERT_TRUE(probe().probeAgain(off, btScalar(0.1), line, again));
    EXPECT_NEAR(again.points.on_a.distance(sample.points.on_a), 0, 1e-3);
    EXPECT_FALSE(probe().probeAgain(off, btScalar(0.1), {}, again));
  }
}

TEST_F(Balls, AreNotProbedAgainWhereTheyAreFar) {
  // Apart by 6 cm: the line to the nearest point, the only one, leads from centre to centre.
  const PlacedPacking apart{*b, at(origin + direction * btScalar(kRadiusA + kRadiusB + 0.06)), Estimator::raw,
                            btScalar(0.1)};
  const PackingProbe probe(placed_a, apart, contacts, 1);
  const btVector3 off = (direction + btVector3(2, 2, 1) / 3 * btScalar(0.36)).normalized();
  constexpr double kFacet = 0.025;  // half the angle of a facet: the nearest point is that of a triangle
  for (const std::size_t index : {0u, 1u}) {
    for (const double separation : {0.05, 0.07}) {
      ProbedSample sample;
      sample.index = index;
      ASSERT_TRUE(probe.probe(off, btScalar(separation), sample));
      EXPECT_NEAR(sample.direction.distance(direction), 0, kFacet);
      EXPECT_NEAR(sample.points.depthAlong(sample.direction), -0.06, kTessellation);
      EXPECT_EQ(sample.isFarFromBend(btScalar(separation)), separation < 0.06);
    }
  }
}

TEST_F(Balls, HaveIdsOfTheirSpheresAndSides) {
  EXPECT_NE(probe().id(0), probe().id(1));
  EXPECT_LT(probe().id(1), kCrossingId);
  const ContactSpheres::Protrusion of_a = probe().protrusion(0, direction),
                                   of_b = probe().protrusion(1, direction);
  EXPECT_TRUE(of_a.of_a);
  EXPECT_FALSE(of_b.of_a);
  EXPECT_NEAR(of_a.distance, kRadiusA, kRounding);
  EXPECT_NEAR(of_b.distance, kRadiusB, kRounding);
}

TEST(ABallOverAnEdge, IsFoundAgainWhenItHasMoved) {
  constexpr double kRadius = 0.5, kDepth = 0.02;
  const auto a = makeShape(latticeBox({1, 1, 1}, 2)), b = makeShape(singleBall(kRadius));
  a->setMargin(0);
  b->setMargin(0);
  const std::vector<SphereContact> contacts{contactOf(0)};  // that of B
  const PlacedPacking placed_a(*a, at({0, 0, 0}), Estimator::raw, btScalar(0.1));
  const btVector3 edge(btScalar(0.5), btScalar(0.03), btScalar(0.5)), up(0, 0, 1);
  const auto placedB = [&](const btVector3& direction) {
    return PlacedPacking(*b, at(edge + direction * btScalar(kRadius - kDepth)), Estimator::raw,
                         btScalar(0.1));
  };
  const btVector3 before(btScalar(0.3), 0, btScalar(std::sqrt(1 - 0.09))),
      now(btScalar(0.31), 0, btScalar(std::sqrt(1 - 0.31 * 0.31)));
  const PlacedPacking b_before = placedB(before), b_now = placedB(now);
  ProbedSample sample;
  ASSERT_TRUE(PackingProbe(placed_a, b_before, contacts, 0).probe(up, btScalar(0.1), sample));
  EXPECT_NEAR(sample.points.depthAlong(sample.direction), kDepth, kTessellation);
  const Samples::Line line{sample.direction, sample.points.triangle_a, sample.points.triangle_b};
  const PackingProbe probe(placed_a, b_now, contacts, 0);
  // The line passes by the cube now.
  ASSERT_FALSE(probe.probeLine(0, line.direction, btVector3(0, 0, 0), sample.points));
  ProbedSample again;
  ASSERT_TRUE(probe.probeAgain(up, btScalar(0.1), line, again));
  EXPECT_NEAR(again.points.depthAlong(again.direction), kDepth, kTessellation);
}

TEST(ACubeInAPlate, IsNotAsDeepAsThePlateIsWide) {
  // The cube stands in the upper face. A line along the plate is in it until the rim, 1.2 m further on.
  constexpr double kDepth = 0.2, kSeparation = 1;
  const auto plate = makeShape(latticeBox({4, 4, 1}, 4)), cube = makeShape(latticeBox({1, 1, 1}, 1));
  plate->setMargin(0);
  cube->setMargin(0);
  // A corner of the plate is as far as this from its nearest sphere.
  const double inset = std::sqrt(2 * 0.5 * 0.5 + 0.125 * 0.125) - 0.125;
  const PlacedPacking a(*plate, at({0, 0, btScalar(-0.5)}), Estimator::raw, btScalar(inset + kSeparation));
  const PlacedPacking b(*cube, at({btScalar(1.3), btScalar(0.5), btScalar(0.5 - kDepth)}), Estimator::raw, 0);
  const auto sphereAt = [&](double x) {
    std::uint32_t i = 0;
    while (a.centreOf(i).distance(btVector3(btScalar(x), btScalar(0.5), btScalar(0.375))) > kRounding) ++i;
    return contactOf(i);
  };
  const std::vector<SphereContact> contacts{sphereAt(0.5), sphereAt(1.5)};
  const PackingProbe probe(a, b, contacts, contacts.size(), false, btScalar(kSeparation));
  OpposedPoints points;
  EXPECT_FALSE(probe.probeLine(0, btVector3(1, 0, 0), btVector3(0, 0, 0), points));
  ASSERT_TRUE(probe.probeLine(1, btVector3(0, 0, 1), btVector3(0, 0, 0), points));
  EXPECT_NEAR(points.depthAlong(btVector3(0, 0, 1)), kDepth, kRounding);
}

/// A cube of 1 m that stands on a corner or an edge, in a slab that is as much as 0.01 m higher. A is the
/// cube.
class CubeOnSlab : public testing::Test {
 protected:
  static constexpr double kDepth = 0.01;

  CubeOnSlab() {
    cube->setMargin(0);
    slab->setMargin(0);
  }
  /// The sphere of the cube that is lowest.
  std::uint32_t lowest(const PlacedPacking& a) const {
    std::uint32_t best = 0;
    for (std::uint32_t i = 0; i < a.count(); ++i) {
      if (a.centreOf(i).z() < a.centreOf(best).z()) best = i;
    }
    return best;
  }
  /// The cube at a height at which its lowest corner is that deep.
  PlacedPacking standing(const btQuaternion& turn) const {
    const btMatrix3x3 axes(turn);
    const btScalar down = btScalar(0.5) * (btFabs(axes[2][0]) + btFabs(axes[2][1]) + btFabs(axes[2][2]));
    return PlacedPacking(*cube, at({0, 0, down - btScalar(kDepth)}, turn), Estimator::raw, btScalar(0.2));
  }
  const std::shared_ptr<PackingShape> cube = makeShape(latticeBox({1, 1, 1}, 4));
  const std::shared_ptr<PackingShape> slab = makeShape(latticeBox({4, 4, 1}, 4));
  const PlacedPacking placed_slab{*slab, at({0, 0, btScalar(-0.5)}), Estimator::raw, btScalar(0.2)};
};

TEST_F(CubeOnSlab, HasItsLowestCornerOverTheFace) {
  const btQuaternion turn(btVector3(1, btScalar(0.3), 0).normalized(), btScalar(0.6));
  const PlacedPacking a = standing(turn);
  const std::vector<SphereContact> contacts{contactOf(lowest(a))};
  const PackingProbe probe(a, placed_slab, contacts, 1);
  const btVector3 down(0, 0, -1);
  ProbedSample sample;
  ASSERT_TRUE(probe.probe(down, btScalar(0.1), sample));
  std::vector<std::uint32_t> vertices;
  std::vector<EdgeContact> corners;
  probe.corners(0, sample.points, down, true, vertices, corners);
  ASSERT_EQ(corners.size(), 1u);
  EXPECT_TRUE(corners[0].is_peak);
  EXPECT_GE(corners[0].id, kCornerId);
  EXPECT_NEAR(corners[0].points.depthAlong(down), kDepth, kRounding);
  EXPECT_NEAR(corners[0].points.on_b.z(), -a.origin().z(), kRounding);
  EXPECT_NEAR(corners[0].points.normal_b.distance(down), 0, 1e-6);
  const btMatrix3x3 axes(turn);
  btVector3 corner;
  for (int k = 0; k < 3; ++k) corner[k] = axes[2][k] > 0 ? btScalar(-0.5) : btScalar(0.5);
  EXPECT_NEAR(corners[0].points.on_a.distance(axes * corner), 0, kRounding);
}

TEST_F(CubeOnSlab, HasBothEndsOfALevelEdgeOverTheFace) {
  const PlacedPacking a = standing(btQuaternion(btVector3(1, 0, 0), btScalar(0.6)));
  const std::vector<SphereContact> contacts{contactOf(lowest(a))};
  const PackingProbe probe(a, placed_slab, contacts, 1);
  const btVector3 down(0, 0, -1);
  ProbedSample sample;
  ASSERT_TRUE(probe.probe(down, btScalar(0.1), sample));
  std::vector<std::uint32_t> vertices;
  std::vector<EdgeContact> corners;
  probe.corners(0, sample.points, down, true, vertices, corners);
  ASSERT_GE(corners.size(), 1u);
  for (const EdgeContact& corner : corners) {
    EXPECT_NEAR(corner.points.depthAlong(down), kDepth, kRounding);
    EXPECT_NEAR(std::fabs(corner.points.on_a.x()), 0.5, kRounding);
  }
}

TEST_F(CubeOnSlab, KnowsHowFarItsFacesGoOn) {
  const PlacedPacking a(*cube, at({0, 0, btScalar(0.5 - kDepth)}), Estimator::raw, btScalar(0.2));
  const std::vector<SphereContact> contacts{contactOf(lowest(a))};
  const PackingProbe probe(a, placed_slab, contacts, 1);
  const btVector3 down(0, 0, -1);
  OpposedPoints points;
  ASSERT_TRUE(probe.probeLine(0, down, btVector3(0, 0, 0), points));
  const btVector3 place = a.origin() + points.on_a;
  const btVector3 ways[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
  for (const btVector3& way : ways) {
    const FaceExtents::EdgeDistances distances = probe.edgeDistances(points, way);
    EXPECT_NEAR(distances.a, 0.5 - place.dot(way), kRounding);
    EXPECT_NEAR(distances.b, 2 - place.dot(way), kRounding);
  }
}

}  // namespace
}  // namespace innersphere::test
