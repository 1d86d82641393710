// A packed cube of which an edge crosses one of a box, hull or mesh bears on it there, however deep it is,
// and whichever of the two is above.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <tuple>

#include "bullet_cube.hpp"
#include "crossing_cubes.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

/// Packing, other shape, and whether the packing is above.
using Kinds = std::tuple<std::string, std::string, bool>;

class CrossingShapes : public testing::TestWithParam<Kinds> {
 protected:
  static ContactOptions rigid() {
    ContactOptions options;
    options.response = Response::rigid;  // its contacts have their true depths
    return options;
  }
  const std::shared_ptr<btCollisionShape> packing = makeCube(std::get<0>(GetParam()));
  BulletCube other{std::get<1>(GetParam())};
  const std::shared_ptr<btCollisionShape> upper = std::get<2>(GetParam()) ? packing : other.shape;
  const std::shared_ptr<btCollisionShape> lower = std::get<2>(GetParam()) ? other.shape : packing;
};

TEST_P(CrossingShapes, PushOneWayThatIsTheLeast) {
  const btTransform turn(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(0.7)));
  // Spheres that have gone through a mesh do not see it.
  const double deepest = other.shape->isConcave() ? 0.1 : 0.25;
  int count = 0;
  for (const Crossing& crossing : crossings()) {
    Cubes cubes = place(crossing);
    cubes = {turn * cubes.upper, turn * cubes.lower};
    const Escape escape = leastEscape(cubes);
    if (!escape.between_edges || escape.next < 1.2 * escape.depth || crossing.depth > deepest) continue;
    SCOPED_TRACE(describe(crossing));
    ++count;
    TestWorld world(rigid());
    world.add(lower, 0, cubes.lower.getOrigin(), cubes.lower.getRotation());
    world.add(upper, 1, cubes.upper.getOrigin(), cubes.upper.getRotation());
    world.world.performDiscreteCollisionDetection();
    const auto points = world.contactsOfLast();
    ASSERT_GE(points.size(), 1u);
    EXPECT_NEAR(-points[0].getDistance(), escape.depth, 1e-4);
    const btVector3& normal = points[0].m_normalWorldOnB;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(normal[i], escape.direction[i], 1e-3);
    // What else touches pushes the same way, or not at all.
    for (const btManifoldPoint& point : points) {
      EXPECT_TRUE(point.getDistance() > 0 || point.m_normalWorldOnB.dot(normal) > btScalar(0.95));
    }
  }
  EXPECT_GT(count, deepest > 0.2 ? 400 : 300);
}

TEST_P(CrossingShapes, GrowWithScaleAndMargin) {
  constexpr double kScale = 2, kMargin = 0.01;
  const bool rounded = std::get<1>(GetParam()) == "hull";  // of the others it is part of the size, or none
  packing->setMargin(btScalar(kMargin));
  if (rounded) other.shape->setMargin(btScalar(kMargin));
  for (const auto& shape : {packing, other.shape})
    shape->setLocalScaling(btVector3(1, 1, 1) * btScalar(kScale));
  for (const double depth : {-0.005, 0.02, 0.1}) {
    const Cubes cubes = place({depth, 1.3, 0.1, -0.2, 0.1, 0.05});
    TestWorld world(rigid());
    world.add(lower, 0, cubes.lower.getOrigin() * btScalar(kScale), cubes.lower.getRotation());
    world.add(upper, 1, cubes.upper.getOrigin() * btScalar(kScale), cubes.upper.getRotation());
    world.world.performDiscreteCollisionDetection();
    const auto points = world.contactsOfLast();
    ASSERT_GE(points.size(), 1u) << depth;
    EXPECT_NEAR(-points[0].getDistance(), depth * kScale + (rounded ? 2 : 1) * kMargin, 1e-4);
    EXPECT_GT(points[0].m_normalWorldOnB.z(), 0.9999) << depth;
  }
}

class CrossingShapesThatMove : public CrossingShapes {};

TEST_P(CrossingShapesThatMove, CarryACubeThatIsGuided) {
  for (const double lean : {0.0, 0.2}) {
    const Cubes cubes = place({-0.05, 1.3, lean, -lean, 0.1, 0.05});
    TestWorld world;
    world.add(lower, 0, cubes.lower.getOrigin(), cubes.lower.getRotation());
    btRigidBody& cube = world.add(upper, 1, cubes.upper.getOrigin(), cubes.upper.getRotation());
    cube.setLinearFactor(btVector3(0, 0, 1));
    cube.setAngularFactor(0);
    const auto escape = [&] { return leastEscape(Cubes{cube.getWorldTransform(), cubes.lower}); };
    double deepest = 0;
    for (int i = 0; i < 480; ++i) {
      world.run(1.0 / 240, 1.0 / 240);
      deepest = std::max(deepest, escape().depth);
    }
    EXPECT_LT(deepest, 0.01);
    EXPECT_NEAR(escape().depth, 0, 0.002);
    EXPECT_NEAR(cube.getLinearVelocity().z(), 0, 1e-3);
  }
}

class CrossingRidges : public testing::TestWithParam<std::string> {};

TEST_P(CrossingRidges, CarryABar) {
  const BulletCube ridge(GetParam());
  constexpr double kHalf = 0.4, kRise = 0.1, kDiagonal = 0.1414213562;
  const btQuaternion edge_down(btVector3(1, 0, 0), btScalar(M_PI / 4));
  const btQuaternion edge_up(btVector3(0, 1, 0), btScalar(M_PI / 4));
  TestWorld world;
  for (const int side : {-1, 1})
    world.add(ridge.shape, 0,
              btVector3(btScalar(side * kHalf), 0, btScalar(side * kRise / 2 - std::sqrt(0.5))), edge_up);
  btRigidBody& bar = world.add(makeShape(latticeBox({1.2, 0.2, 0.2}, 6)), 1,
                               btVector3(0, 0, btScalar(kDiagonal + 0.15)), edge_down);
  // It does not roll off its edge.
  bar.setLinearFactor(btVector3(0, 0, 1));
  bar.setAngularFactor(btVector3(0, 1, 0));
  world.run(2, 1.0 / 240);
  const btTransform& at = bar.getWorldTransform();
  const btVector3 along = at.getBasis().getColumn(0);
  EXPECT_NEAR(along.z() / along.x(), kRise / (2 * kHalf), 0.002);
  EXPECT_NEAR(at.getOrigin().z(), kDiagonal / along.x(), 0.001);
  EXPECT_NEAR(bar.getLinearVelocity().length(), 0, 1e-3);
}

const auto kPackings = testing::Values("lattice", "cut", "500", "4000");
const auto kOthers = testing::Values("box", "hull", "mesh", "cut_mesh", "inside_out_mesh");

std::string nameOf(const testing::TestParamInfo<Kinds>& info) {
  const auto& [packing, other, is_above] = info.param;
  return packing + (is_above ? "_on_" : "_below_") + other;
}

INSTANTIATE_TEST_SUITE_P(Of, CrossingShapes, testing::Combine(kPackings, kOthers, testing::Bool()), nameOf);
INSTANTIATE_TEST_SUITE_P(Above, CrossingShapesThatMove,
                         testing::Combine(kPackings, kOthers, testing::Values(true)), nameOf);
INSTANTIATE_TEST_SUITE_P(Below, CrossingShapesThatMove,
                         testing::Combine(kPackings, testing::Values("box", "hull"), testing::Values(false)),
                         nameOf);
INSTANTIATE_TEST_SUITE_P(Of, CrossingRidges, kOthers);

}  // namespace
}  // namespace innersphere::test
