// Points of contact of solids whose depth is known in closed form.
#include "narrow_phase/contact_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <btBulletCollisionCommon.h>

#include "test_packings.hpp"

namespace innersphere::test {
namespace {

using Kind = WeightedPoint::Kind;
constexpr double kRounding = 5e-5, kDepth = 0.01, kSeparation = 0.02;
const btVector3 kDown(0, 0, -1);

std::shared_ptr<PackingShape> withoutMargin(Packing packing) {
  auto shape = makeShape(std::move(packing));
  shape->setMargin(0);
  return shape;
}

/// A lies on B; all spheres of either near the other are samples of one patch of 2 m^2 whose normal is down.
class Pair {
 public:
  Pair(Packing packing_a, const btTransform& place_a, Packing packing_b, const btTransform& place_b)
      : shape_a(withoutMargin(std::move(packing_a))),
        shape_b(withoutMargin(std::move(packing_b))),
        a(*shape_a, place_a, Estimator::raw, btScalar(kSeparation)),
        b(*shape_b, place_b, Estimator::raw, btScalar(0)) {
    add(a, b);
    count_a = contacts.size();
    add(b, a);
    for (std::size_t i = 0; i < contacts.size(); ++i) samples.indices.push_back(i);
    samples.patches.push_back({kDown, 2, btScalar(0.4), contacts.size()});
  }
  std::vector<WeightedPoint> find(double separation = kSeparation) {
    std::vector<WeightedPoint> found;
    findContactPoints(PackingProbe(a, b, contacts, count_a), 0, {btScalar(separation)}, {}, samples, scratch,
                      found);
    return found;
  }

  std::shared_ptr<PackingShape> shape_a, shape_b;
  PlacedPacking a, b;
  std::vector<SphereContact> contacts;
  std::size_t count_a = 0;
  Samples samples;
  SampleScratch scratch;

 private:
  void add(const PlacedPacking& of, const PlacedPacking& other) {
    for (std::uint32_t i = 0; i < of.count(); ++i) {
      SurfaceQueries::Nearest nearest;
      const btVector3 place = of.origin() + of.centreOf(i) - other.origin();
      if (!other.nearest(place, of.ownRadius(i) + btScalar(0.15), nearest)) continue;
      contacts.emplace_back();
      contacts.back().sphere = i;
    }
  }
};

btTransform at(double x, double y, double z, const btQuaternion& turn = btQuaternion::getIdentity()) {
  return btTransform(turn, btVector3(btScalar(x), btScalar(y), btScalar(z)));
}

Packing cube() {
  return latticeBox({1, 1, 1}, 6);
}

Packing slab() {
  return latticeBox({4, 4, 1}, 8);
}

WeightedPoint deepestOf(const std::vector<WeightedPoint>& found) {
  return *std::max_element(found.begin(), found.end(), [](const WeightedPoint& p, const WeightedPoint& q) {
    return p.point.depth < q.point.depth;
  });
}

TEST(ContactPoints, OfAFaceOnAFaceAreAsDeepEverywhere) {
  Pair pair(cube(), at(0, 0, 0.5 - kDepth), slab(), at(0, 0, -0.5));
  const std::vector<WeightedPoint> found = pair.find();
  ASSERT_GE(found.size(), 16u);
  double area = 0;
  for (const WeightedPoint& p : found) {
    area += p.area;
    EXPECT_NEAR(p.point.depth, kDepth, kRounding);
    EXPECT_NEAR(p.point.normal.distance(kDown), 0, kRounding);
    EXPECT_NEAR(p.point.on_b.z(), -0.5 + kDepth, kRounding);
    EXPECT_LE(std::fabs(p.point.on_b.x()), 0.5 + kRounding);
    EXPECT_NEAR(p.point.turn_a, 0.5, 0.5);
    EXPECT_EQ(p.radius, btScalar(0.4));
  }
  EXPECT_NEAR(area, 2, 1e-4);
}

TEST(ContactPoints, OfACornerAreAtTheCorner) {
  const btQuaternion turn(btVector3(1, btScalar(0.4), 0).normalized(), btScalar(0.6));
  const btMatrix3x3 axes(turn);
  btVector3 corner;
  for (int k = 0; k < 3; ++k) corner[k] = axes[2][k] > 0 ? btScalar(-0.5) : btScalar(0.5);
  const btVector3 lowest = axes * corner;
  Pair pair(cube(), at(0.1, 0, -double(lowest.z()) - kDepth, turn), slab(), at(0, 0, -0.5));
  const WeightedPoint deepest = deepestOf(pair.find());
  EXPECT_EQ(deepest.kind, Kind::corner);
  EXPECT_NEAR(deepest.point.depth, kDepth, kRounding);
  EXPECT_NEAR(deepest.point.normal.distance(kDown), 0, kRounding);
  EXPECT_NEAR(deepest.point.on_b.distance(lowest + btVector3(0, 0, btScalar(kDepth))), 0, kRounding);
  EXPECT_NEAR(deepest.point.turn_a, 0, 1e-3);
}

TEST(ContactPoints, SamplesFarFromACornerThatTheyFoundStay) {
  const btQuaternion turn(btVector3(1, btScalar(0.4), 0).normalized(), btScalar(0.6));
  const btMatrix3x3 axes(turn);
  btVector3 corner;
  for (int k = 0; k < 3; ++k) corner[k] = axes[2][k] > 0 ? btScalar(-0.5) : btScalar(0.5);
  const btVector3 centre = axes * -corner;
  Pair pair(cube(), at(centre.x(), centre.y(), centre.z() - kDepth, turn), singleBall(2), at(0, 0, -2));
  const double separation = kSeparation / 2;
  const auto find = [&](const std::vector<std::size_t>& indices) {
    pair.samples = Samples();
    pair.samples.indices = indices;
    pair.samples.patches.push_back({kDown, 2, btScalar(0.4), indices.size()});
    return pair.find(separation);
  };
  const auto isFar = [&](std::size_t i) {
    return !find({i}).empty() && pair.scratch.probed.front().isFar(btScalar(separation));
  };
  const auto isNear = [&](std::size_t i) { return !find({i}).empty() && !isFar(i); };
  std::vector<std::size_t> far, near;
  for (std::size_t i = 0; i < pair.contacts.size(); ++i) {
    if (isFar(i)) far.push_back(i);
    if (isNear(i)) near.push_back(i);
  }
  ASSERT_FALSE(far.empty());
  ASSERT_FALSE(near.empty());
  for (const std::size_t i : far) {
    const std::vector<WeightedPoint> found = find({i, near.front()});  // the ascent begins at the second
    EXPECT_EQ(deepestOf(found).kind, Kind::corner);
    EXPECT_NEAR(deepestOf(found).point.depth, kDepth, 1e-3);  // the ball is cut into triangles
    dropUnprobed(pair.samples);
    EXPECT_EQ(pair.samples.indices, (std::vector<std::size_t>{i, near.front()}));
  }
}

TEST(ContactPoints, OfCrossingEdgesAreAtTheCrossing) {
  const double half = std::sqrt(0.5);
  Pair pair(cube(), at(0.1, 0.05, half - kDepth, btQuaternion(btVector3(0, 1, 0), SIMD_HALF_PI / 2)), cube(),
            at(0, 0, -half, btQuaternion(btVector3(1, 0, 0), SIMD_HALF_PI / 2)));
  const std::vector<WeightedPoint> found = pair.find();
  int crossings = 0;
  for (const WeightedPoint& p : found) {
    EXPECT_LT(p.point.depth, kDepth + kRounding);
    if (p.kind != Kind::crossing) continue;
    ++crossings;
    EXPECT_NEAR(p.point.depth, kDepth, kRounding);
    EXPECT_NEAR(p.point.normal.distance(kDown), 0, kRounding);
    EXPECT_NEAR(p.point.on_b.x(), 0, kRounding);
    EXPECT_NEAR(p.point.on_b.y(), -0.05, kRounding);
  }
  EXPECT_EQ(crossings, 1);
}

TEST(ContactPoints, OfTwoBallsHaveTheirDeepestBetweenTheCentres) {
  const btVector3 direction = btVector3(btScalar(0.2), btScalar(-0.1), -1).normalized();
  const btVector3 b = direction * btScalar(1.5 - kDepth);
  Pair pair(singleBall(1), at(0, 0, 0), singleBall(0.5), at(b.x(), b.y(), b.z()));
  const WeightedPoint deepest = deepestOf(pair.find());
  EXPECT_NEAR(deepest.point.depth, kDepth, 6e-4);  // the balls are cut into triangles
  EXPECT_NEAR(deepest.point.normal.distance(direction), 0, 0.01);
  EXPECT_NEAR(deepest.point.bend_a.mean(), 1, 0.02);
  EXPECT_NEAR(deepest.point.bend_b.mean(), 2, 0.04);
}

TEST(ContactPoints, AreNoneFurtherApartThanTheSeparation) {
  Pair pair(cube(), at(0, 0, 0.515), slab(), at(0, 0, -0.5));
  for (const WeightedPoint& p : pair.find()) EXPECT_NEAR(p.point.depth, -0.015, kRounding);
  EXPECT_FALSE(pair.find().empty());
  EXPECT_TRUE(pair.find(0.01).empty());
}

TEST(ContactPoints, AreTheSameWhereTheirLinesAreKnown) {
  const btQuaternion turn(btVector3(1, btScalar(0.4), 0).normalized(), btScalar(0.02));
  Pair pair(cube(), at(0, 0, 0.505, turn), slab(), at(0, 0, -0.5));
  const std::vector<WeightedPoint> first = pair.find();
  ASSERT_EQ(pair.samples.lines.size(), pair.samples.indices.size());
  const std::vector<WeightedPoint> again = pair.find();
  ASSERT_FALSE(first.empty());
  ASSERT_EQ(again.size(), first.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(again[i].point.id, first[i].point.id);
    EXPECT_NEAR(again[i].point.depth, first[i].point.depth, kRounding);
    EXPECT_NEAR(again[i].point.on_b.distance(first[i].point.on_b), 0, 1e-3);
  }
}

TEST(ContactPoints, OnAPlaneAreThoseOfACube) {
  const btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  const auto shape = withoutMargin(cube());
  const btTransform world = btTransform::getIdentity();
  const btQuaternion turn(btVector3(1, btScalar(0.4), 0).normalized(), btScalar(0.6));
  const btMatrix3x3 axes(turn);
  btVector3 corner;
  for (int k = 0; k < 3; ++k) corner[k] = axes[2][k] > 0 ? btScalar(-0.5) : btScalar(0.5);
  const btVector3 lowest = axes * corner;
  // Flat on the plane its face counts, and so do the corners in which it ends; on its corner that alone does.
  const struct {
    btTransform place;
    std::ptrdiff_t corners;
    bool face;
  } cases[] = {{at(2, 3, 0.5 - kDepth), 4, true}, {at(2, 3, -double(lowest.z()) - kDepth, turn), 1, false}};
  for (const auto& [place, corners, face] : cases) {
    const PlacedPacking a(*shape, place, Estimator::raw, btScalar(0.15));
    const auto surface = makeShapeSurface(plane);
    std::vector<NearSphere> spheres;
    surface->findNearSpheres(a, world, spheres);
    Samples samples;
    for (std::size_t i = 0; i < spheres.size(); ++i) samples.indices.push_back(i);
    samples.patches.push_back({kDown, 2, 1, spheres.size()});
    SampleScratch scratch;
    std::vector<WeightedPoint> found;
    findContactPoints(ShapeProbe(a, *surface, world, spheres), 0, {btScalar(kSeparation)}, {}, samples, scratch,
                      found);
    ASSERT_FALSE(found.empty());
    const auto count = [&](Kind kind) {
      return std::count_if(found.begin(), found.end(), [&](const WeightedPoint& p) {
        return p.kind == kind && std::fabs(p.point.depth - kDepth) < kRounding;
      });
    };
    EXPECT_EQ(count(Kind::corner), corners);
    EXPECT_EQ(count(Kind::faces) > 0, face);
    EXPECT_NEAR(deepestOf(found).point.depth, kDepth, kRounding);
    for (const WeightedPoint& p : found) EXPECT_NEAR(p.point.normal.distance(kDown), 0, kRounding);
  }
}

TEST(ContactPoints, OfACylinderOnASlabAreTheEndsOfItsLineOnceEach) {
  constexpr double kHalf = 0.5, kRadius = 0.3, kMargin = 0.02;
  const btVector3 half_extents{btScalar(kHalf), btScalar(kRadius), btScalar(kRadius)};
  btCylinderShapeX cylinder(half_extents);
  cylinder.setMargin(btScalar(kMargin));
  const auto shape = withoutMargin(slab());
  const PlacedPacking a(*shape, at(0, 0, -0.5), Estimator::raw, btScalar(0.15));
  const btTransform world = at(0.2, 0.1, kRadius - kDepth);
  const auto surface = makeShapeSurface(cylinder);
  std::vector<NearSphere> spheres;
  surface->findNearSpheres(a, world, spheres);
  Samples samples;
  for (std::size_t i = 0; i < spheres.size(); ++i) samples.indices.push_back(i);
  ASSERT_GE(samples.indices.size(), 4u);
  samples.patches.push_back({-kDown, 2, 1, spheres.size()});
  SampleScratch scratch;
  std::vector<WeightedPoint> found;
  findContactPoints(ShapeProbe(a, *surface, world, spheres), 0, {btScalar(kSeparation)}, {}, samples, scratch,
                    found);
  for (const double end : {0.2 - kHalf + kMargin, 0.2 + kHalf - kMargin}) {
    const btVector3 expected(btScalar(end), btScalar(0.1), btScalar(0.5 - kDepth));
    const auto isThere = [&](const WeightedPoint& p) {
      return p.kind == Kind::edge && p.point.on_b.distance(expected) < kRounding;
    };
    ASSERT_EQ(std::count_if(found.begin(), found.end(), isThere), 1);
    const WeightedPoint point = *std::find_if(found.begin(), found.end(), isThere);
    EXPECT_NEAR(point.point.depth, kDepth, kRounding);
    EXPECT_NEAR(point.point.normal.distance(-kDown), 0, kRounding);
    EXPECT_NEAR(point.point.to_top.length(), 0, kRounding);
    EXPECT_NEAR(point.point.bend_b.mean(), 1 / kRadius / 2, 1e-4);
  }
  EXPECT_EQ(
      std::count_if(found.begin(), found.end(),
                    [](const WeightedPoint& p) { return p.point.id >= kCornerId && p.kind == Kind::edge; }),
      2);
}

}  // namespace
}  // namespace innersphere::test
