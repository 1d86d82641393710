// Masses of 1 to 1e6. In free space an impact without restitution leaves both with the speed of their common
// centre of mass, whatever the ratio, and a light body rests on a heavy one as on a floor. A light body under
// a load of many times its mass is more than ten iterations of Bullet's solver can hold: it is squeezed, but
// nothing flies and no energy comes from nowhere.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "watched_world.hpp"

namespace innersphere::test {
namespace {

class MassRatio : public testing::TestWithParam<double> {};

TEST_P(MassRatio, ImpactKeepsTheMomentum) {
  const double ratio = GetParam();  // of the one that is hit
  WatchedWorld world;
  world.world.setGravity(btVector3(0, 0, 0));
  const auto shape = makeShape(latticeBox({1, 1, 1}, 6));
  btRigidBody& a = world.add(shape, 1, btVector3(0, 0, 0));
  btRigidBody& b = world.add(shape, ratio, btVector3(btScalar(1.1), 0, 0));
  for (btRigidBody* body : {&a, &b}) body->setFriction(0);
  a.setLinearVelocity(btVector3(1, 0, 0));
  world.watch(2, 1.0 / 240);
  const double common = 1 / (1 + ratio);
  EXPECT_TRUE(world.finite());
  EXPECT_NEAR(a.getLinearVelocity().x(), common, 0.01);
  EXPECT_NEAR(b.getLinearVelocity().x(), common, 0.01 * std::min(1.0, 1 / ratio));
  EXPECT_LE(world.gain(), 1e-5);
}

TEST_P(MassRatio, ALightBoxRestsOnAHeavyOneAndIsNotThrownFromUnderOne) {
  const double ratio = GetParam();  // of the upper one
  WatchedWorld world;
  world.addFloor();
  const auto shape = makeShape(latticeBox({1, 1, 1}, 6));
  const btRigidBody& lower = world.add(shape, 1, btVector3(0, 0, btScalar(0.5)));
  const btRigidBody& upper = world.add(shape, ratio, btVector3(0, 0, btScalar(1.5)));
  world.watch(3, 1.0 / 240);
  EXPECT_TRUE(world.finite());
  if (ratio <= 10) {
    EXPECT_NEAR(lower.getWorldTransform().getOrigin().z(), 0.5, 0.005);
    EXPECT_NEAR(upper.getWorldTransform().getOrigin().z(), 1.5, 0.01);
  }
  EXPECT_LE(world.gain(), 1e-3 * (1 + ratio) * 9.81);
}

INSTANTIATE_TEST_SUITE_P(Of, MassRatio, testing::Values(1e-6, 1e-3, 1e-1, 1, 10.0, 1e3, 1e6),
                         [](const auto& info) {
                           return std::string("1e") + (info.param < 1 ? "minus" : "") +
                                  std::to_string(std::abs(std::lround(std::log10(info.param))));
                         });

}  // namespace
}  // namespace innersphere::test
