// Balls and cylinders, known in closed form, on an edge of a box.
#include "narrow_phase/over_edge.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "outline_meshes.hpp"
#include "test_packings.hpp"

namespace innersphere::test {
namespace {

using FaceEnd = EdgeProbe::FaceEnd;
constexpr double kRounding = 2e-5;

/// A solid that is turned and moved, and something round over the face in which it ends upwards, z = 0 in its
/// own frame.
class OverEdge : public testing::Test {
 protected:
  btVector3 placed(double x, double y, double z) const {
    return at + world.getBasis() * btVector3(btScalar(x), btScalar(y), btScalar(z));
  }
  btVector3 turned(double x, double y, double z) const { return placed(x, y, z) - at; }

  /// From a place of the face to below where something of this radius has the face's normal.
  FaceEnd lie(double x, double y, const btVector3& to_top, double radius, const NearestRound& nearest_round) {
    const PlacedPacking body(*shape, world, Estimator::raw, 0);
    // The middle of the solid is 1 m below its face.
    const SharpEdges solid(body, placed(0, 0, -1));
    OpposedPoints points;
    (of_a ? points.on_a : points.on_b) = placed(x, y, double(shape->getMargin()));
    (of_a ? points.curvature_b : points.curvature_a) = btScalar(1 / radius);
    EXPECT_TRUE(solid.nearestTriangle(placed(x, y, 0), of_a ? points.triangle_a : points.triangle_b));
    points.normal_a = points.normal_b = turned(0, 0, of_a ? 1 : -1);
    contact = EdgeContact();
    return lieOverEdge(solid, of_a, nearest_round, points, to_top, contact);
  }
  /// The same of a ball.
  FaceEnd lieBall(double x, double y, const btVector3& centre, double radius) {
    const btVector3 up = turned(0, 0, 1), way = centre - placed(x, y, 0);
    return lie(x, y, way - up * way.dot(up), radius, [&](const btVector3& place, RoundPoint& nearest) {
      nearest.normal = (place - centre).normalized();
      nearest.at = centre + nearest.normal * btScalar(radius);
      return true;
    });
  }
  btVector3 onSolid() const { return of_a ? contact.points.on_a : contact.points.on_b; }
  btVector3 onRound() const { return of_a ? contact.points.on_b : contact.points.on_a; }
  btVector3 outOfSolid() const { return contact.points.normal_a * btScalar(of_a ? 1 : -1); }

  std::shared_ptr<PackingShape> shape = makeShape(latticeBox({2, 4, 2}, 2));
  const btTransform world{btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(0.7)), btVector3(7, 8, 9)};
  const btVector3 at{btScalar(0.3), btScalar(-0.2), btScalar(0.1)};
  bool of_a = true;
  EdgeContact contact;
};

TEST_F(OverEdge, ABallLiesWhereTheEdgeIsNearestToItsCentre) {
  constexpr double kRadius = 0.5;
  for (const double margin : {0.0, 0.03}) {
    shape->setMargin(btScalar(margin));
    for (const double beyond : {0.02, 0.1, 0.3}) {
      for (of_a = true;; of_a = false) {
        const double height = 0.4, to_edge = std::hypot(beyond, height);
        const btVector3 out = turned(beyond / to_edge, 0, height / to_edge);
        ASSERT_EQ(lieBall(0.8, 0.3, placed(1 + beyond, -0.6, height), kRadius), FaceEnd::in_edge) << beyond;
        EXPECT_NEAR(onSolid().distance(placed(1, -0.6, 0) + out * btScalar(margin)), 0, kRounding);
        EXPECT_NEAR((onSolid() - onRound()).dot(out), kRadius + margin - to_edge, kRounding);
        EXPECT_NEAR(outOfSolid().distance(out), 0, kRounding);
        EXPECT_EQ(contact.points.normal_a, contact.points.normal_b);
        EXPECT_NEAR(std::fabs(contact.along.dot(turned(0, 1, 0))), 1, kRounding);
        if (!of_a) break;
      }
    }
  }
}

TEST_F(OverEdge, ABallLiesOnTheFaceWhereThatGoesOnBelowIt) {
  shape->setMargin(0);
  EXPECT_EQ(lieBall(0.5, 0.3, placed(0.99, 0.3, 0.4), 0.5), FaceEnd::on_face);
  EXPECT_EQ(lieBall(0.5, 0.3, placed(1.01, 0.3, 0.4), 0.5), FaceEnd::in_edge);
}

TEST_F(OverEdge, ABallBesideAFaceIsBorneByTheNextOne) {
  shape->setMargin(0);
  EXPECT_EQ(lieBall(0.5, 0.3, placed(1.45, 0.3, -0.1), 0.5), FaceEnd::beyond);
}

TEST_F(OverEdge, ABallBeyondTheEndOfAnEdgeDoesNotLieOnIt) {
  shape->setMargin(0);
  EXPECT_EQ(lieBall(0.9, 1.9, placed(1.2, 2.01, 0.4), 0.5), FaceEnd::beyond);
  EXPECT_EQ(lieBall(0.9, 1.9, placed(1.2, 1.99, 0.4), 0.5), FaceEnd::in_edge);
}

TEST_F(OverEdge, ACylinderAlongTheEdgeLiesOnItAllAlong) {
  shape->setMargin(0);
  constexpr double kRadius = 0.5, kBeyond = 0.1, kHeight = 0.45;
  const double to_edge = std::hypot(kBeyond, kHeight);
  // Parallel, or leaning from the edge by less than bodies that roll.
  for (const double lean : {0.0, 0.03}) {
    const btVector3 axis = turned(0, std::cos(lean), std::sin(lean)),
                    middle = placed(1 + kBeyond, 0, kHeight);
    const auto nearest_round = [&](const btVector3& place, RoundPoint& nearest) {
      const btVector3 centre = middle + axis * axis.dot(place - middle);
      nearest.normal = (place - centre).normalized();
      nearest.at = centre + nearest.normal * btScalar(kRadius);
      return true;
    };
    ASSERT_EQ(lie(0.8, 0.3, turned(0.2 + kBeyond, 0, 0), kRadius, nearest_round), FaceEnd::in_edge) << lean;
    const btVector3 on_edge = onSolid() - placed(1, 0, 0);
    EXPECT_NEAR(on_edge.dot(turned(1, 0, 0)), 0, kRounding);
    EXPECT_NEAR(on_edge.dot(turned(0, 0, 1)), 0, kRounding);
    EXPECT_LE(std::fabs(on_edge.dot(turned(0, 1, 0))), 2 + kRounding);
    EXPECT_NEAR(outOfSolid().dot(contact.along), 0, kRounding);
    if (lean > 0) continue;
    EXPECT_NEAR(on_edge.dot(turned(0, 1, 0)), 0.3, kRounding);
    EXPECT_NEAR((onSolid() - onRound()).length(), kRadius - to_edge, kRounding);
  }
}

TEST_F(OverEdge, ABallOnARimIsNotOnAnyEdgeOfItsMesh) {
  Packing disc = singleBall(1);
  disc.surface = surfaceOf(turnedMesh({{0, -1}, {1, -1}, {1, 1}, {0, 1}}));
  shape = makeShape(std::move(disc));
  shape->setMargin(0);
  EXPECT_EQ(lieBall(0.8, 0.1, placed(1.1, 0.1, 0.4), 0.5), FaceEnd::unknown);
}

}  // namespace
}  // namespace innersphere::test
