// Which spheres of a packing are near a primitive shape, against its distance in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <ostream>
#include <random>

#include <btBulletCollisionCommon.h>

#include "narrow_phase/shapes/shape_surface.hpp"
#include "test_packings.hpp"

namespace innersphere::test {
namespace {

using Point = std::array<double, 3>;

double lengthOf(const Point& p) {
  return std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
}

/// A shape, and how far a point is from it: double precision, and no code of ours.
struct Primitive {
  const char* name;
  std::shared_ptr<btCollisionShape> shape;
  std::function<double(const Point&)> distance;
  double curvature;  ///< [1/m]

  friend void PrintTo(const Primitive& primitive, std::ostream* out) { *out << primitive.name; }
};

double boxDistance(const Point& p, const Point& half) {
  Point outside{};
  double deepest = -1e9;
  for (std::size_t k = 0; k < 3; ++k) {
    const double beyond = std::fabs(p[k]) - half[k];
    outside[k] = std::max(beyond, 0.0);
    deepest = std::max(deepest, beyond);
  }
  return deepest > 0 ? lengthOf(outside) : deepest;
}

struct Ball {
  Point centre;
  double radius;
};

std::shared_ptr<btMultiSphereShape> hullOf(const std::vector<Ball>& balls) {
  std::vector<btVector3> centres;
  std::vector<btScalar> radii;
  for (const Ball& ball : balls) {
    centres.emplace_back(btScalar(ball.centre[0]), btScalar(ball.centre[1]), btScalar(ball.centre[2]));
    radii.push_back(btScalar(ball.radius));
  }
  return std::make_shared<btMultiSphereShape>(centres.data(), radii.data(), int(balls.size()));
}

std::vector<Primitive> primitives() {
  const auto capsule = [](Point p) {
    p[1] -= std::min(0.5, std::max(-0.5, p[1]));
    return lengthOf(p) - 0.4;
  };
  const auto plane = [](const Point& p) { return (p[0] + 2 * p[1] + 2 * p[2]) / 3 - 0.1; };
  return {
      {"sphere", std::make_shared<btSphereShape>(btScalar(0.7)),
       [](const Point& p) { return lengthOf(p) - 0.7; }, 1 / 0.7},
      {"box", std::make_shared<btBoxShape>(btVector3(btScalar(0.4), btScalar(0.5), btScalar(0.6))),
       [](const Point& p) {
         return boxDistance(p, {0.4, 0.5, 0.6});
       },
       0},
      {"capsule", std::make_shared<btCapsuleShape>(btScalar(0.4), btScalar(1)), capsule, 1 / 0.4},
      {"spheres", hullOf({{{0, -0.5, 0}, 0.4}, {{0, 0.5, 0}, 0.4}}), capsule, 1 / 0.4},
      {"plane", std::make_shared<btStaticPlaneShape>(btVector3(1, 2, 2) / 3, btScalar(0.1)), plane, 0},
  };
}

class Primitives : public testing::TestWithParam<Primitive> {
 protected:
  static constexpr double kMargin = 0.03, kSearch = 0.2, kScale = 1.5;

  Primitives() {
    shape_->setMargin(btScalar(kMargin));
    shape_->setLocalScaling(btVector3(btScalar(kScale), btScalar(kScale), btScalar(kScale)));
  }
  /// Body and shape somewhere, turned, so that they overlap.
  static btTransform somewhere(std::mt19937& rng, double size) {
    std::uniform_real_distribution<double> u(-1, 1);
    const btVector3 axis = btVector3{btScalar(u(rng)), btScalar(u(rng)), btScalar(u(rng) + 1.1)}.normalized();
    const btVector3 place{btScalar(size * u(rng)), btScalar(size * u(rng)), btScalar(size * u(rng))};
    return btTransform(btQuaternion(axis, btScalar(3 * u(rng))), place);
  }
  PlacedPacking placed(const btTransform& place) const {
    return PlacedPacking(*shape_, place, Estimator::raw, btScalar(kSearch));
  }
  /// Of the centre of a sphere, in the frame of the other shape.
  Point centreIn(const PlacedPacking& body, const btTransform& world, std::size_t i) const {
    const btVector3 p = world.invXform(body.origin() + body.centreOf(i));
    return {p.x(), p.y(), p.z()};
  }
  /// As far out as the normal says the distance grows.
  void expectNear(const PlacedPacking& body, const btTransform& world, const NearSphere& near) const {
    const Point p = centreIn(body, world, near.sphere);
    const double expected = GetParam().distance(p);
    EXPECT_NEAR(near.distance, expected, 1e-5);
    EXPECT_NEAR(near.normal.length(), 1, 1e-5);
    EXPECT_NEAR(near.curvature, GetParam().curvature, 1e-5);
    const btVector3 n = world.getBasis().transpose() * near.normal;
    constexpr double kStep = 1e-3;
    const Point out{p[0] + kStep * n.x(), p[1] + kStep * n.y(), p[2] + kStep * n.z()};
    if (!near.isOnEdge()) {
      EXPECT_NEAR(GetParam().distance(out), expected + kStep, 1e-5);
    }
  }

  std::shared_ptr<PackingShape> shape_ = makeShape(withoutSurface(latticeBox({0.5, 0.5, 0.5}, 5)));
};

TEST_P(Primitives, HaveAllSpheresNearThemAndNoOthers) {
  std::mt19937 rng(9);
  std::size_t all = 0;
  for (int k = 0; k < 50; ++k) {
    const btTransform world = somewhere(rng, 3);
    const PlacedPacking body = placed(world * somewhere(rng, 0.8));
    const auto surface = makeShapeSurface(*GetParam().shape);
    std::vector<NearSphere> found;
    surface->findNearSpheres(body, world, found);
    std::map<std::size_t, int> times;
    for (const NearSphere& near : found) {
      ++times[near.sphere];
      expectNear(body, world, near);
    }
    const double radius = 0.05 * 0.999999 * kScale + kMargin + kSearch;
    for (std::size_t i = 0; i < body.count(); ++i) {
      const double distance = GetParam().distance(centreIn(body, world, i));
      if (std::fabs(distance - radius) < 1e-4) continue;
      EXPECT_EQ(times[i], distance < radius ? 1 : 0) << distance;
    }
    all += found.size();
  }
  EXPECT_GT(all, 500u);
}

TEST_P(Primitives, RenewDistancesWhereBodiesHaveMoved) {
  std::mt19937 rng(10);
  const btTransform world = somewhere(rng, 3);
  const btTransform place = world * somewhere(rng, 0.3);
  const auto surface = makeShapeSurface(*GetParam().shape);
  std::vector<NearSphere> found;
  surface->findNearSpheres(placed(place), world, found);
  ASSERT_FALSE(found.empty());
  const btTransform moved(btQuaternion(btVector3(0, 0, 1), btScalar(0.1)), btVector3(btScalar(0.05), 0, 0));
  const PlacedPacking body = placed(place * moved);
  ASSERT_TRUE(surface->updateNearSpheres(body, world, found));
  for (const NearSphere& near : found) expectNear(body, world, near);
}

TEST_P(Primitives, KnowTheDistanceOfAPlaceOutside) {
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> u(-1.5, 1.5);
  const btTransform world = somewhere(rng, 3);
  const PlacedPacking body = placed(somewhere(rng, 3));
  const auto surface = makeShapeSurface(*GetParam().shape);
  for (int i = 0; i < 200; ++i) {
    const Point p{u(rng), u(rng), u(rng)};
    const double expected = GetParam().distance(p);
    if (expected < 1e-3) continue;
    const btVector3 place = world(btVector3(btScalar(p[0]), btScalar(p[1]), btScalar(p[2]))) - body.origin();
    btScalar distance = 0;
    ASSERT_TRUE(surface->distanceOf(body, world, place, distance));
    EXPECT_NEAR(distance, expected, 1e-5);
  }
}

TEST_P(Primitives, NoticeThatTheyHaveChanged) {
  const auto surface = makeShapeSurface(*GetParam().shape);
  surface->isAsBefore();
  EXPECT_TRUE(surface->isAsBefore());
  btCollisionShape& shape = *GetParam().shape;
  if (shape.getShapeType() == STATIC_PLANE_PROXYTYPE) return;  // a plane cannot change
  shape.setLocalScaling(btVector3(2, 2, 2));
  EXPECT_FALSE(surface->isAsBefore());
  EXPECT_TRUE(surface->isAsBefore());
  shape.setLocalScaling(btVector3(1, 1, 1));
  EXPECT_FALSE(surface->isAsBefore());
}

/// How far outside of the hull of balls a point is: the most that any plane around it tells, which is looked
/// for at random, nearer and nearer to the best.
double hullDistance(const std::vector<Ball>& balls, const Point& p, std::mt19937& rng) {
  std::normal_distribution<double> part;
  Point best{1, 0, 0};
  double most = -1e9, step = 10;
  for (int i = 0; i < 3000; ++i) {
    Point way{best[0] + step * part(rng), best[1] + step * part(rng), best[2] + step * part(rng)};
    const double length = lengthOf(way);
    double inside = -1e9, at = 0;
    for (double& x : way) x /= length;
    for (const Ball& ball : balls) {
      double reach = ball.radius;
      for (std::size_t k = 0; k < 3; ++k) reach += ball.centre[k] * way[k];
      inside = std::max(inside, reach);
    }
    for (std::size_t k = 0; k < 3; ++k) at += p[k] * way[k];
    if (at - inside > most) {
      most = at - inside;
      best = way;
    }
    step = std::max(1e-6, step * 0.995);
  }
  return most;
}

TEST(MultiSpheres, AreTheHullsOfTheirSpheres) {
  std::mt19937 rng(12);
  std::uniform_real_distribution<double> u(-1.5, 1.5);
  const std::vector<Ball> all{
      {{-0.5, 0, 0}, 0.4}, {{0.4, 0.1, 0}, 0.2}, {{0, 0.6, 0.3}, 0.3}, {{0.1, 0, 0}, 0.1}};
  for (const std::size_t count : {1, 2, 3, 4}) {
    const std::vector<Ball> balls(all.begin(), all.begin() + std::ptrdiff_t(count));
    const auto shape = hullOf(balls);
    const auto surface = makeShapeSurface(*shape);
    const auto packing = makeShape(withoutSurface(latticeBox({0.5, 0.5, 0.5}, 5)));
    const PlacedPacking body(*packing, btTransform::getIdentity(), Estimator::raw, 0);
    for (int i = 0; i < 300; ++i) {
      const Point p{u(rng), u(rng), u(rng)};
      const double expected = hullDistance(balls, p, rng);
      if (expected < 0.01) continue;
      btScalar distance = 0;
      ASSERT_TRUE(surface->distanceOf(body, btTransform::getIdentity(),
                                      btVector3(btScalar(p[0]), btScalar(p[1]), btScalar(p[2])), distance));
      EXPECT_NEAR(distance, expected, count < 3 ? 1e-4 : 1e-3) << count;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Primitives, testing::ValuesIn(primitives()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace innersphere::test
