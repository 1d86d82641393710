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
  const std::shared_ptr<btCollisionShape> packing = makeCube(std::get<0>(GetParam()));
  BulletCube other{std::get<1>(GetParam())};
  const std::shared_ptr<btCollisionShape> upper = std::get<2>(GetParam()) ? packing : other.shape;
  const std::shared_ptr<btCollisionShape> lower = std::get<2>(GetParam()) ? other.shape : packing;
};

TEST_P(CrossingShapes, PushOneWayThatIsTheLeast) {
  // Spheres that have gone through a mesh do not see it.
  const double deepest = other.shape->isConcave() ? 0.1 : 0.25;
  EXPECT_GT(expectLeastPushes(upper, lower, deepest), deepest > 0.2 ? 400 : 300);
}

TEST_P(CrossingShapes, GrowWithScaleAndMargin) {
  constexpr double kMargin = 0.01;
  const bool rounded = std::get<1>(GetParam()) == "hull";  // of the others it is part of the size, or none
  packing->setMargin(btScalar(kMargin));
  if (rounded) other.shape->setMargin(btScalar(kMargin));
  expectDepthsOfTwiceTheSize(upper, lower, (rounded ? 2 : 1) * kMargin);
}

class CrossingShapesThatMove : public CrossingShapes {};

TEST_P(CrossingShapesThatMove, CarryACubeThatIsGuided) {
  expectGuidedCubeIsCarried(upper, lower);
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
