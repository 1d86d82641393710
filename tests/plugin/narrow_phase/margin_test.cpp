// The margin makes a solid larger on all sides: contacts come that much earlier.
#include <gtest/gtest.h>

#include "bullet_shapes.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kMargin = 0.1;

class Margin : public testing::TestWithParam<std::string> {};

TEST_P(Margin, BodiesRestThatMuchHigher) {
  TestWorld world;
  const BulletShape ground = makeBulletShape(GetParam());
  world.add(ground.shape, 0, ground.place.getOrigin(), ground.place.getRotation());
  const auto shape = makeShape(latticeBox({1, 1, 1}, 8));
  shape->setMargin(btScalar(kMargin));
  btRigidBody& cube = world.add(shape, 1, btVector3(0, 0, btScalar(0.5 + kMargin + 0.02)));
  world.run(1.5);
  EXPECT_NEAR(cube.getWorldTransform().getOrigin().z(), 0.5 + kMargin, 0.005);
  shape->setMargin(0);
  cube.activate();
  world.run(1.5);
  EXPECT_NEAR(cube.getWorldTransform().getOrigin().z(), 0.5, 0.005);
}

INSTANTIATE_TEST_SUITE_P(Grounds, Margin,
                         testing::Values("plane", "box", "sphere", "capsule_x", "convex_hull",
                                         "triangle_mesh", "terrain", "packing"),
                         [](const auto& info) { return info.param; });

TEST(Margins, OfTwoPackingsAddUp) {
  TestWorld world;
  const auto lower = makeShape(latticeBox({2, 2, 2}, 8));
  const auto upper = makeShape(latticeBox({1, 1, 1}, 8));
  lower->setMargin(btScalar(0.05));
  upper->setMargin(btScalar(kMargin));
  world.add(lower, 0, btVector3(0, 0, -1));
  btRigidBody& cube = world.add(upper, 1, btVector3(0, 0, btScalar(0.67)));
  world.run(1.5);
  EXPECT_NEAR(cube.getWorldTransform().getOrigin().z(), 0.65, 0.005);
}

TEST(Margins, OfSpheresWithoutASurface) {
  TestWorld world;
  world.addFloor();
  const auto shape = makeShape(withoutSurface(latticeBox({1, 1, 1}, 8)));
  shape->setMargin(btScalar(kMargin));
  btRigidBody& cube = world.add(shape, 1, btVector3(0, 0, btScalar(0.62)));
  world.run(1.5);
  EXPECT_NEAR(cube.getWorldTransform().getOrigin().z(), 0.6, 0.01);
}

}  // namespace
}  // namespace innersphere::test
