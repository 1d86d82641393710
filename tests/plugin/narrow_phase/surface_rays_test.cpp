// Where lines leave and enter boxes and balls, and where the corners of boxes and cylinders are, which is
// known in closed form.
#include "narrow_phase/surface_rays.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "narrow_phase/solid_corner.hpp"
#include "outline_meshes.hpp"
#include "test_packings.hpp"

namespace innersphere::test {
namespace {

/// Vertices are kept in single precision, and so are the boxes of the tree.
constexpr double kRounding = 2e-5;
/// Of the ball of 1 m: its triangles are at most 0.07 m long, so that they cut 0.07^2 / 8 off, and the curved
/// surface that they stand for is much nearer.
constexpr double kTessellation = 6e-4;
constexpr double kFar = 100;

const Vec3d kHalf{0.5, 1, 1.5};

btTransform somewhere() {
  return btTransform(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(0.7)),
                     btVector3(btScalar(0.3), btScalar(-2), 5));
}

/// A turned box, twice as large as its packing.
struct TurnedBox {
  TurnedBox() : shape(makeShape(latticeBox({kHalf[0], kHalf[1], kHalf[2]}, 2))) {
    shape->setLocalScaling(btVector3(2, 2, 2));
    shape->setMargin(0);
  }
  PlacedPacking placed() const { return PlacedPacking(*shape, somewhere(), Estimator::raw, 0); }
  std::shared_ptr<PackingShape> shape;
};

/// How far the line p + t d is inside of the box: from enter to leave, and the axes of the faces there.
struct Slab {
  double enter = -1e9, leave = 1e9;
  int enter_axis = 0, leave_axis = 0;
};

Slab slabOf(const btVector3& p, const btVector3& d) {
  Slab slab;
  for (int k = 0; k < 3; ++k) {
    double first = (-kHalf[k] - p[k]) / d[k], last = (kHalf[k] - p[k]) / d[k];
    if (first > last) std::swap(first, last);
    if (first > slab.enter) {
      slab.enter = first;
      slab.enter_axis = k;
    }
    if (last < slab.leave) {
      slab.leave = last;
      slab.leave_axis = k;
    }
  }
  return slab;
}

class RandomLines {
 public:
  btVector3 direction() {
    std::normal_distribution<double> normal;
    return btVector3(btScalar(normal(rng_)), btScalar(normal(rng_)), btScalar(normal(rng_))).normalized();
  }
  btVector3 inside() {
    std::uniform_real_distribution<double> u(-0.9, 0.9);
    return btVector3(btScalar(u(rng_) * kHalf[0]), btScalar(u(rng_) * kHalf[1]),
                     btScalar(u(rng_) * kHalf[2]));
  }

 private:
  std::mt19937 rng_{11};
};

TEST(SurfaceRays, LeaveABoxByTheFaceInTheirWay) {
  TurnedBox box;
  const PlacedPacking body = box.placed();
  const btMatrix3x3& axes = body.world.getBasis();
  RandomLines lines;
  int left = 0;
  for (int i = 0; i < 1000; ++i) {
    const btVector3 p = lines.inside(), d = lines.direction();
    const Slab slab = slabOf(p, d);
    const double cosine = std::fabs(d[slab.leave_axis]);
    if (std::fabs(cosine - 0.5) < 1e-3) continue;
    SurfacePoint point;
    const bool leaves = leaveSolid(body, axes * p, axes * d, btScalar(kFar), OpposedPoints::kNone, point);
    // At a flat angle it is the side of the solid.
    ASSERT_EQ(leaves, cosine > 0.5);
    EXPECT_NEAR(point.facing, cosine, 1e-4);
    if (!leaves) continue;
    ++left;
    EXPECT_NEAR(point.at.distance(axes * (p + d * btScalar(slab.leave))), 0, kRounding);
    EXPECT_NEAR(std::fabs(point.normal.dot(axes.getColumn(slab.leave_axis))), 1, 1e-6);
    EXPECT_EQ(point.curvature, 0);
    // The same from the triangle that is known.
    SurfacePoint again;
    ASSERT_TRUE(leaveSolid(body, axes * p, axes * d, btScalar(kFar), point.triangle, again));
    EXPECT_NEAR(again.at.distance(point.at), 0, kRounding);
  }
  EXPECT_GT(left, 500);
}

TEST(SurfaceRays, EnterABoxAheadOrBehind) {
  TurnedBox box;
  const PlacedPacking body = box.placed();
  const btMatrix3x3& axes = body.world.getBasis();
  RandomLines lines;
  int ahead = 0, behind = 0;
  for (int i = 0; i < 1000; ++i) {
    const btVector3 p = lines.inside(), d = lines.direction();
    const Slab slab = slabOf(p, d);
    const double cosine = std::fabs(d[slab.enter_axis]);
    if (std::fabs(cosine - 0.5) < 1e-3) continue;
    const btVector3 expected = axes * (p + d * btScalar(slab.enter));
    const bool starts_inside = i % 2 == 0;
    const btVector3 from = starts_inside ? axes * p : axes * (p + d * btScalar(slab.enter - 1));
    SurfacePoint point;
    const bool enters =
        enterSolid(body, from, axes * d, btScalar(kFar), OpposedPoints::kNone, axes * d, point);
    ASSERT_EQ(enters, cosine > 0.5) << i;
    if (!enters) continue;
    ++(starts_inside ? behind : ahead);
    EXPECT_NEAR(point.at.distance(expected), 0, kRounding);
    EXPECT_NEAR(point.normal.dot(axes * d), -cosine, 1e-4);
  }
  EXPECT_GT(ahead, 200);
  EXPECT_GT(behind, 200);
}

TEST(SurfaceRays, GoNoFurtherThanTheirLength) {
  TurnedBox box;
  const PlacedPacking body = box.placed();
  const btVector3 x = body.world.getBasis().getColumn(0);
  SurfacePoint point;
  EXPECT_FALSE(leaveSolid(body, btVector3(0, 0, 0), x, btScalar(0.49), OpposedPoints::kNone, point));
  EXPECT_TRUE(leaveSolid(body, btVector3(0, 0, 0), x, btScalar(0.51), OpposedPoints::kNone, point));
}

TEST(SurfaceRays, LeaveThatMuchLaterWithAMargin) {
  TurnedBox box;
  box.shape->setMargin(btScalar(0.1));
  const PlacedPacking body = box.placed();
  const btVector3 x = body.world.getBasis().getColumn(0);
  SurfacePoint point;
  ASSERT_TRUE(leaveSolid(body, btVector3(0, 0, 0), x, 1, OpposedPoints::kNone, point));
  EXPECT_NEAR(point.at.dot(x), kHalf[0] + 0.1, kRounding);
  ASSERT_TRUE(enterSolid(body, x * -2, x, 4, OpposedPoints::kNone, x, point));
  EXPECT_NEAR(point.at.dot(x), -kHalf[0] - 0.1, kRounding);
}

TEST(SurfaceRays, LeaveABallWhereALineDoes) {
  const auto shape = makeShape(singleBall(1));
  shape->setMargin(0);
  const PlacedPacking body(*shape, somewhere(), Estimator::raw, 0);
  RandomLines lines;
  for (int i = 0; i < 500; ++i) {
    const btVector3 p = lines.direction() * btScalar(0.4), d = lines.direction();
    const double along = p.dot(d);
    const double way = -along + std::sqrt(along * along - double(p.length2()) + 1);
    SurfacePoint point;
    ASSERT_TRUE(leaveSolid(body, p, d, btScalar(kFar), OpposedPoints::kNone, point));
    const btVector3 expected = p + d * btScalar(way);
    EXPECT_NEAR(point.at.distance(expected), 0, kTessellation);
    EXPECT_NEAR(point.normal.distance(expected), 0, 4e-3);
    EXPECT_NEAR(point.curvature, 1, 0.02);
  }
}

TEST(SurfaceRays, FindTheFaceUnderAPlaceOnlyWhereThereIsOne) {
  TurnedBox box;
  const PlacedPacking body = box.placed();
  const btMatrix3x3& axes = body.world.getBasis();
  const btVector3 x = axes.getColumn(0);
  SurfacePoint point;
  for (const double height : {-0.03, 0.0, 0.02}) {
    const btVector3 place = axes * btVector3(btScalar(kHalf[0] + height), btScalar(0.3), btScalar(-0.4));
    ASSERT_TRUE(faceUnder(body, place, x, 0, btScalar(0.5), point)) << height;
    EXPECT_NEAR(point.at.dot(x), kHalf[0], kRounding);
  }
  // Beside the face, and under another one.
  EXPECT_FALSE(
      faceUnder(body, axes * btVector3(btScalar(kHalf[0]), btScalar(1.2), 0), x, 0, btScalar(0.5), point));
  EXPECT_FALSE(faceUnder(body, axes * btVector3(btScalar(0.1), btScalar(0.3), 0), axes.getColumn(2), 0,
                         btScalar(0.5), point));
}

TEST(SurfaceRays, FindTheFaceUnderAPlaceOnlyAsDeepAsTheSolidIs) {
  TurnedBox box;
  const PlacedPacking body = box.placed();
  const btVector3 x = body.world.getBasis().getColumn(0), place = x * btScalar(kHalf[0]);
  SurfacePoint point;
  ASSERT_TRUE(faceUnder(body, place, x, btScalar(2 * kHalf[0] - 0.01), btScalar(0.5), point));
  EXPECT_NEAR(point.at.dot(x), kHalf[0], kRounding);
  EXPECT_FALSE(faceUnder(body, place, x, btScalar(2 * kHalf[0] + 0.01), btScalar(0.5), point));
}

/// A corner of another solid that is less deep than it is away from where the face ends leaves by the face.
TEST(SurfaceRays, FindTheFaceUnderACornerCloseToWhereItEnds) {
  TurnedBox box;
  const PlacedPacking body = box.placed();
  const btMatrix3x3& axes = body.world.getBasis();
  constexpr double kToEnd = 0.01;
  const btVector3 place = axes * btVector3(btScalar(kHalf[0]), btScalar(kHalf[1] - kToEnd), btScalar(0.2));
  SurfacePoint point;
  for (const double depth : {-0.03, -1e-4, 0.0, 1e-4, 0.9 * kToEnd}) {
    ASSERT_TRUE(faceUnder(body, place, axes.getColumn(0), btScalar(depth), btScalar(0.5), point)) << depth;
    EXPECT_NEAR(point.at.distance(place), 0, kRounding);
  }
  EXPECT_FALSE(faceUnder(body, place, axes.getColumn(0), btScalar(1.1 * kToEnd), btScalar(0.5), point));
}

TEST(SolidCorner, IsUphill) {
  TurnedBox box;
  box.shape->setMargin(btScalar(0.05));
  const PlacedPacking body = box.placed();
  const btMatrix3x3& axes = body.world.getBasis();
  RandomLines lines;
  for (int i = 0; i < 100; ++i) {
    const btVector3 local = lines.direction(), direction = axes * local;
    btVector3 expected;
    for (int k = 0; k < 3; ++k) expected[k] = btScalar(local[k] < 0 ? -kHalf[k] : kHalf[k]);
    std::vector<std::uint32_t> vertices;
    ASSERT_TRUE(cornersUphill(body, std::size_t(i) % 12, direction, btVector3(0, 0, 0), 10, vertices));
    ASSERT_FALSE(vertices.empty());
    const btVector3 corner = axes * expected + direction * btScalar(0.05);
    EXPECT_NEAR(SolidCorner(body, vertices[0], direction).at().distance(corner), 0, kRounding);
  }
}

/// A cylinder about z, which is turned, and twice as large as its packing.
struct TurnedCylinder {
  static constexpr std::uint32_t kAround = 24;
  static constexpr double kRadius = 0.6;

  TurnedCylinder() {
    Packing packing = singleBall(0.3);
    packing.surface = surfaceOf(turnedMesh({{0, -1}, {kRadius / 2, -1}, {kRadius / 2, 1}, {0, 1}}, kAround));
    shape = makeShape(std::move(packing));
    shape->setLocalScaling(btVector3(2, 2, 2));
  }
  /// Across the axis.
  btVector3 outwards(double angle) const {
    return somewhere().getBasis() * btVector3(btScalar(std::cos(angle)), btScalar(std::sin(angle)), 0);
  }
  std::shared_ptr<PackingShape> shape;
};

TEST(SolidCorner, OfARimBelongsToItsSide) {
  const TurnedCylinder cylinder;
  const PlacedPacking body(*cylinder.shape, somewhere(), Estimator::raw, 0);
  constexpr double kFacet = 2 * M_PI / TurnedCylinder::kAround;
  for (std::uint32_t vertex = 0; vertex < 2 * TurnedCylinder::kAround; ++vertex) {
    const double angle = vertex % TurnedCylinder::kAround * kFacet;
    for (const double beside : {0.0, 0.4, -0.4, 0.9, -0.9, 1.1, -1.1, 3.9, -3.9, 4.1, 6.0, 12.0}) {
      const btVector3 way = cylinder.outwards(angle + beside * kFacet);
      for (const bool of_a : {true, false}) {
        EdgeContact rim;
        const OpposedPoints& corner = rim.points;
        // Four facets are 60 degrees: beyond, it is another part of the solid that is furthest out.
        const bool is_of_side = std::fabs(beside) < 4;
        const SolidCorner found(body, vertex, way);
        found.giveTo(of_a, rim);
        EXPECT_EQ(found.goesOn(), is_of_side && std::fabs(beside) > 1) << beside;
        const btVector3& normal = of_a ? corner.normal_a : corner.normal_b;
        // On the rim's circle, where it is furthest out, unless that is beyond the next corner.
        const btVector3 outwards = std::fabs(beside) < 1 ? way : cylinder.outwards(angle);
        const btVector3 expected = is_of_side ? outwards * btScalar(of_a ? 1 : -1) : btVector3(0, 0, 0);
        EXPECT_NEAR(normal.distance(expected), 0, kRounding);
        EXPECT_NEAR(of_a ? corner.curvature_a : corner.curvature_b,
                    is_of_side ? 1 / TurnedCylinder::kRadius : 0, 1e-4);
        EXPECT_EQ((of_a ? corner.triangle_a : corner.triangle_b) == OpposedPoints::kNone, !is_of_side);
      }
    }
  }
}

TEST(SolidCorner, TakesARimForACircle) {
  const TurnedCylinder cylinder;
  const PlacedPacking body(*cylinder.shape, somewhere(), Estimator::raw, 0);
  constexpr double kFacet = 2 * M_PI / TurnedCylinder::kAround;
  const btVector3 axis = body.world.getBasis().getColumn(2);
  for (std::uint32_t vertex = TurnedCylinder::kAround; vertex < 2 * TurnedCylinder::kAround; ++vertex) {
    for (const double beside : {0.0, 0.3, -0.5, 0.9}) {
      for (const double lean : {0.02, 0.5, 1.0}) {
        const double angle = (vertex % TurnedCylinder::kAround + beside) * kFacet;
        const btVector3 outwards = cylinder.outwards(angle),
                        way = outwards * btScalar(std::cos(lean)) + axis * btScalar(std::sin(lean));
        const btVector3 crest = outwards * btScalar(TurnedCylinder::kRadius) + axis * 2;
        const SolidCorner found(body, vertex, way);
        EXPECT_NEAR(found.at().distance(crest), 0, 2e-3) << beside << " " << lean;
        EdgeContact rim;
        found.giveTo(true, rim);
        EXPECT_FALSE(found.goesOn());
        EXPECT_NEAR(rim.points.normal_a.distance(outwards), 0, 2e-3);
        EXPECT_NEAR(std::fabs(rim.along.dot(outwards.cross(axis))), 1, 1e-5);
        EXPECT_NEAR(rim.bend_along, std::cos(lean) / TurnedCylinder::kRadius, 0.01);
      }
    }
  }
}

TEST(SolidCorner, OfFlatFacesBelongsToNone) {
  const TurnedBox box;
  const PlacedPacking body = box.placed();
  const TurnedCylinder cylinder;
  const PlacedPacking round(*cylinder.shape, somewhere(), Estimator::raw, 0);
  std::vector<SolidCorner> corners;
  for (std::uint32_t vertex = 0; vertex < 8; ++vertex)
    corners.emplace_back(body, vertex, body.world.getBasis().getColumn(0));
  // Along its axis a cylinder ends in a flat face.
  corners.emplace_back(round, 0, -round.world.getBasis().getColumn(2));
  for (const SolidCorner& corner : corners) {
    EdgeContact contact;
    corner.giveTo(true, contact);
    EXPECT_FALSE(corner.goesOn());
    EXPECT_TRUE(contact.points.normal_a.isZero());
    EXPECT_EQ(contact.points.curvature_a, 0);
    EXPECT_EQ(contact.points.triangle_a, OpposedPoints::kNone);
  }
}

}  // namespace
}  // namespace innersphere::test
