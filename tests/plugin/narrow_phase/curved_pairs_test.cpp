// The deepest place between curved solids is that of closed forms, wherever the spheres are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "innersphere/packer.hpp"
#include "innersphere/solids.hpp"
#include "named_packings.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kRadius = 0.12;  // [m] of B
constexpr double kDegree = M_PI / 180;
constexpr int kPlacements = 1000;

struct Near {
  double distance;   ///< [m], negative inside
  btVector3 normal;  ///< unit, outwards
  bool curved = true;
};

/// A solid that reaches `radius` around a curve.
struct Tube {
  std::shared_ptr<PackingShape> shape;
  double radius;
  std::function<btVector3(double)> curve;  ///< over 0 to 1
  bool ends = false;
};

/// A solid with a distance in closed form.
struct Other {
  std::shared_ptr<btCollisionShape> shape;
  std::function<Near(const btVector3&)> near;
  /// Of the body, where the solid is at a pose.
  std::function<btTransform(const btTransform&)> body = [](const btTransform& pose) { return pose; };
};

Tube makeTube(const std::string& name) {
  constexpr double kRing = 0.35, kTube = 0.1, kHalf = 0.35;
  if (name == "ring") {
    return {makeTorusShape(kRing, kTube, 1000), kTube, [](double t) {
              return btVector3(btScalar(kRing * std::cos(2 * M_PI * t)),
                               btScalar(kRing * std::sin(2 * M_PI * t)), 0);
            }};
  }
  PackOptions options;
  options.spheres = 1000;
  if (name == "ball")
    return {makeShape(pack(*makeBall(kTube), options)), kTube, [](double) { return btVector3(0, 0, 0); }};
  return {makeShape(pack(*makeCylinder(kTube, 2 * kHalf), options)), kTube,
          [](double t) { return btVector3(0, 0, btScalar((2 * t - 1) * kHalf)); }, true};
}

Near nearSegment(const btVector3& p, double half, double radius) {
  btVector3 off = p;
  off.setY(off.y() - btClamped(off.y(), btScalar(-half), btScalar(half)));
  return {off.length() - radius, off.normalized()};
}

/// The side of a cylinder about the y axis.
Near nearSide(const btVector3& p, double half, double radius) {
  const btVector3 off(p.x(), 0, p.z());
  return {off.length() - radius, off.normalized(), std::fabs(p.y()) < half};
}

/// The side of a cone about the y axis, its middle at half height, thickened by `margin`.
Near nearSlope(const btVector3& p, double radius, double height, double margin) {
  const double slant = std::hypot(radius, height), out = std::hypot(p.x(), p.z());
  const double normal_out = height / slant, normal_up = radius / slant;
  const double from_rim = out - radius, up = p.y() + height / 2;
  const double along = (up * normal_out - from_rim * normal_up) / slant;
  const btVector3 outwards(btScalar(p.x() / out), 0, btScalar(p.z() / out));
  const btVector3 normal = outwards * btScalar(normal_out) + btVector3(0, btScalar(normal_up), 0);
  const double distance = from_rim * normal_out + up * normal_up;
  return {distance - margin, normal, along > 0.05 && along < 0.9};
}

/// A ring of that tube about the z axis.
Near nearRing(const btVector3& p, double ring, double radius) {
  const btVector3 flat = btVector3(p.x(), p.y(), 0).normalized() * btScalar(ring), off = p - flat;
  return {off.length() - radius, off.normalized()};
}

Other makeOther(const std::string& name) {
  constexpr double kHalf = 0.5, kRim = 0.05;
  const btVector3 extents(kRadius, kHalf, kRadius);
  if (name == "sphere")
    return {std::make_shared<btSphereShape>(btScalar(kRadius)),
            [](const btVector3& p) { return nearSegment(p, 0, kRadius); }};
  if (name == "capsule") {
    return {std::make_shared<btCapsuleShape>(btScalar(kRadius), btScalar(2 * kHalf)),
            [](const btVector3& p) { return nearSegment(p, kHalf, kRadius); }};
  }
  if (name == "cylinder")
    return {std::make_shared<btCylinderShape>(extents),
            [](const btVector3& p) { return nearSide(p, kHalf - kRim, kRadius); }};
  if (name == "cone") {
    auto cone = std::make_shared<btConeShape>(btScalar(2 * kRadius), btScalar(1));
    const double margin = cone->getMargin();
    return {cone, [=](const btVector3& p) { return nearSlope(p, 2 * kRadius, 1, margin); }};
  }
  if (name == "packed ring") {
    constexpr double kRing = 0.4;
    const std::shared_ptr<PackingShape> shape = makeTorusShape(kRing, kRadius, 1000);
    return {shape, [](const btVector3& p) { return nearRing(p, kRing, kRadius); },
            [shape](const btTransform& pose) { return shape->bodyTransform(pose); }};
  }
  PackOptions options;
  options.spheres = 1000;
  return {makeShape(pack(*makeBall(kRadius), options)),
          [](const btVector3& p) { return nearSegment(p, 0, kRadius); }};
}

/// The deepest place of a tube at `a` in B at `b`.
struct Deepest {
  double depth;
  double t;          ///< on the curve
  btVector3 normal;  ///< out of B
  btVector3 on_b;
  double valley;  ///< how fast the depth falls along the curve [1/m]
  bool curved;
};

class Pair {
 public:
  Pair(const std::string& tube, const std::string& other) : tube_(makeTube(tube)), other_(makeOther(other)) {}

  Deepest deepest(const btTransform& a, const btTransform& b) const {
    constexpr int kCoarse = 90, kFine = 40;
    constexpr double kGolden = 0.381966;
    double best = 0;
    for (int i = 1; i < kCoarse; ++i) {
      if (gap(a, b, double(i) / kCoarse) < gap(a, b, best)) best = double(i) / kCoarse;
    }
    double low = best - 1.0 / kCoarse, high = best + 1.0 / kCoarse;
    for (int i = 0; i < kFine; ++i) {
      const double p = low + kGolden * (high - low), q = high - kGolden * (high - low);
      (gap(a, b, p) < gap(a, b, q) ? high : low) = gap(a, b, p) < gap(a, b, q) ? q : p;
    }
    const double t = (low + high) / 2, h = 0.02;
    const btVector3 centre = a * tube_.curve(t);
    const Near near = other_.near(b.invXform(centre));
    const btVector3 normal = b.getBasis() * near.normal;
    const double way = tube_.curve(t + h).distance(tube_.curve(t));
    const double bend = gap(a, b, t + h) + gap(a, b, t - h) - 2 * gap(a, b, t);
    return {tube_.radius - near.distance,
            t,
            normal,
            centre - normal * btScalar(near.distance),
            way > 0 ? bend / (way * way) : 1 / kRadius,
            near.curved && !(tube_.ends && (t < 0.06 || t > 0.94))};
  }

  const Tube& tube() const { return tube_; }
  const Other& other() const { return other_; }

 private:
  double gap(const btTransform& a, const btTransform& b, double t) const {
    return other_.near(b.invXform(a * tube_.curve(t))).distance - tube_.radius;
  }
  Tube tube_;
  Other other_;
};

/// The deepest contact that the world finds.
struct FindDeepest : btCollisionWorld::ContactResultCallback {
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* object0, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    if (-point.getDistance() < depth) return 0;
    const bool swapped = object0->getCollisionObject() != a;
    depth = -point.getDistance();
    normal = swapped ? -point.m_normalWorldOnB : point.m_normalWorldOnB;
    on_b = swapped ? point.getPositionWorldOnA() : point.getPositionWorldOnB();
    return 0;
  }
  const btCollisionObject* a = nullptr;
  btScalar depth = -1;
  btVector3 normal{0, 0, 0};
  btVector3 on_b{0, 0, 0};
};

class CurvedPairs : public testing::TestWithParam<std::tuple<std::string, std::string>> {};

/// Moves a along a random line until it is `depth` deep in b.
btTransform touching(const Pair& pair, const btTransform& b, double depth, std::mt19937& rng) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> aside(-0.3, 0.3);
  const auto vector = [&](auto& from) {
    return btVector3(btScalar(from(rng)), btScalar(from(rng)), btScalar(from(rng)));
  };
  const btVector3 axis = vector(normal), way = vector(normal).normalized(), start = vector(aside);
  btTransform a(btQuaternion(axis.normalized(), btScalar(normal(rng))), start);
  double low = 0, high = 3;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    a.setOrigin(start + way * btScalar(middle));
    (pair.deepest(a, b).depth < depth ? high : low) = middle;
  }
  a.setOrigin(start + way * btScalar(high));
  return a;
}

TEST_P(CurvedPairs, MeetAtTheDeepestPlace) {
  const Pair pair(std::get<0>(GetParam()), std::get<1>(GetParam()));
  TestWorld world;
  btRigidBody& a = world.add(pair.tube().shape, 1, btVector3(0, 0, 0));
  btRigidBody& b = world.add(pair.other().shape, 0, btVector3(0, 0, 0));
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> depths(-0.003, 0.003);
  int tried = 0, beside = 0;
  for (int i = 0; i < kPlacements; ++i) {
    const btTransform place(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(i)), btVector3(0, 0, 0));
    const double depth = depths(rng);
    const btTransform mesh = touching(pair, place, depth, rng);
    const Deepest expected = pair.deepest(mesh, place);
    if (!expected.curved || std::fabs(expected.depth - depth) > 1e-5)
      continue;  // ends and rims are not round
    ++tried;
    a.setWorldTransform(pair.tube().shape->bodyTransform(mesh));
    b.setWorldTransform(pair.other().body(place));
    FindDeepest found;
    found.a = &a;
    found.m_closestDistanceThreshold = btScalar(0.01);
    world.world.contactPairTest(&a, &b, found);
    const double angle = std::asin(std::min(1.0, double(found.normal.cross(expected.normal).length())));
    const double away = found.on_b.distance(expected.on_b);
    // Where tubes are nearly parallel, half a degree is further away than a hundredth of the radius.
    const double allowed = std::max(0.01 * kRadius, 0.5 * kDegree / expected.valley);
    EXPECT_GT(found.normal.dot(expected.normal), 0) << i;
    EXPECT_NEAR(found.depth, expected.depth, 1e-3 * kRadius) << i;
    EXPECT_LT(angle, kDegree) << i;
    EXPECT_LT(away, 2 * allowed) << i << ", valley " << expected.valley;
    if (angle > 0.5 * kDegree || away > allowed) ++beside;
  }
  // Triangles stand in for a ring's curve: of rings three times as fine none meet half a degree beside it.
  const int of_a = std::get<0>(GetParam()) == "ring" ? 2 : 0;
  const int of_b = std::get<1>(GetParam()) == "packed ring" ? 3 : 0;
  EXPECT_LE(beside, of_a + of_b);
  EXPECT_GT(tried, kPlacements / 4);
}

INSTANTIATE_TEST_SUITE_P(All, CurvedPairs,
                         testing::Combine(testing::Values("ring", "ball", "tube"),
                                          testing::Values("sphere", "capsule", "cylinder", "cone",
                                                          "packed ball", "packed ring")),
                         [](const auto& info) {
                           std::string name = std::get<0>(info.param) + "_on_" + std::get<1>(info.param);
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

}  // namespace
}  // namespace innersphere::test
