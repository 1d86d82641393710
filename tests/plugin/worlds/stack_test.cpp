#include <gtest/gtest.h>

#include "named_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

class Stack : public testing::TestWithParam<std::tuple<Response, double>> {};

TEST_P(Stack, OfThreeBoxesStands) {
  const auto& [response, dt] = GetParam();
  ContactOptions options;
  options.response = response;
  TestWorld world(options);
  world.addFloor();
  const auto shape = makeNamedShape("box", 800, std::sqrt(0.75));
  for (int i = 0; i < 3; ++i) {
    world.add(shape, 1, btVector3(btScalar(0.01 * i), btScalar(-0.005 * i), btScalar(0.51 + 1.01 * i)));
  }
  world.run(5, dt);
  EXPECT_LT(world.kineticEnergy(), 1e-4);
  for (int i = 0; i < 3; ++i) {
    const btRigidBody& box = *world.bodies[1 + i];
    EXPECT_NEAR(box.getWorldTransform().getOrigin().z(), 0.5 + i, 0.005 * (1 + i)) << "box " << i;
    EXPECT_LT(tiltDegrees(box), 0.5);
    EXPECT_FALSE(box.isActive()) << "not asleep";
  }
}

INSTANTIATE_TEST_SUITE_P(Responses, Stack,
                         testing::Combine(testing::Values(Response::compliant, Response::rigid),
                                          testing::Values(1.0 / 60, 1.0 / 240)));

}  // namespace
}  // namespace innersphere::test
