// Bullet moves kinematic bodies before it looks for contact, and all others after it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kStep = 1.0 / 60, kStroke = 0.1;  // [s], [m]

struct Lift {
  Response response;
  bool packed;
};

class Kinematic : public testing::TestWithParam<Lift> {
 protected:
  Kinematic() : world({.response = GetParam().response}) {}

  btRigidBody& addLift(const btVector3& size) {
    std::shared_ptr<btCollisionShape> shape = std::make_shared<btBoxShape>(size / 2);
    if (GetParam().packed) shape = makeShape(latticeBox({size.x(), size.y(), size.z()}, 8));
    btRigidBody& lift = world.add(shape, 0, btVector3(0, 0, -size.z() / 2));
    lift.setCollisionFlags(lift.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    lift.setActivationState(DISABLE_DEACTIVATION);
    lift.setFriction(4);
    return lift;
  }

  TestWorld world;
};

/// Once a second up and down and, by friction, to and fro: at up to 0.63 m/s, which is 10.5 mm a step, and at
/// less than gravity.
TEST_P(Kinematic, ALiftTouchesWhatItCarriesAllTheTime) {
  btRigidBody& lift = addLift(btVector3(2, 2, 1));
  const btRigidBody& cube = world.add(makeShape(latticeBox({1, 1, 1}, 6)), 1, btVector3(0, 0, btScalar(0.5)));
  const btVector3 start = lift.getWorldTransform().getOrigin();
  double least = 1, most = -1, slip = 0;
  for (int i = 1; i <= 120; ++i) {
    btTransform place = lift.getWorldTransform();
    const double height = kStroke * (1 - std::cos(2 * std::numbers::pi * i * kStep));
    place.setOrigin(start + btVector3(btScalar(height), 0, btScalar(height)));
    lift.setWorldTransform(place);
    world.run(kStep, kStep);
    const double gap = cube.getWorldTransform().getOrigin().z() - 0.5 - height;
    least = std::min(least, gap);
    most = std::max(most, gap);
    slip = std::max(slip, std::abs(cube.getWorldTransform().getOrigin().x() - height));
  }
  EXPECT_GT(least, -0.0015);
  EXPECT_LT(most, 0.0015);
  EXPECT_LT(slip, 0.0015);
}

INSTANTIATE_TEST_SUITE_P(All, Kinematic,
                         testing::Values(Lift{Response::compliant, true}, Lift{Response::compliant, false},
                                         Lift{Response::rigid, true}, Lift{Response::rigid, false}),
                         [](const auto& info) {
                           return nameOf(info.param.response) + (info.param.packed ? "Packing" : "Box");
                         });

}  // namespace
}  // namespace innersphere::test
