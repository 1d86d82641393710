#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "innersphere/mesh.hpp"
#include "named_packings.hpp"
#include "packing/mesh_shapes.hpp"
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

/// Feet stand near the rims of thin tops, beside the legs below. Small spheres of a foot were pushed to the
/// side of the top, all the way through it, and drove the tables apart: at 60 steps/s the stack fell.
TEST(Tables, StandOnEachOther) {
  constexpr double kHeight = 0.5, kTop = 0.04;
  Mesh mesh = boxMesh({-0.4, -0.3, kHeight - kTop}, {0.4, 0.3, kHeight});
  for (const double x : {-0.38, 0.34}) {
    for (const double y : {-0.28, 0.24})
      append(mesh, boxMesh({x, y, 0}, {x + 0.04, y + 0.04, kHeight - kTop}));
  }
  const auto shape = makePackedShape(*makeSolid(mesh, "table"), 256);
  for (const double aside : {0.01, 0.015, 0.02}) {
    TestWorld world;
    PackingCollisionAlgorithm::prepareWorld(world.world);
    world.addFloor();
    std::vector<btTransform> starts;
    for (int i = 0; i < 5; ++i) {
      const btVector3 place(btScalar(aside * (i % 2)), 0, btScalar((kHeight + 0.005) * i + 0.005));
      starts.push_back(shape->bodyTransform(btTransform(btQuaternion::getIdentity(), place)));
      world.add(shape, 5, starts.back().getOrigin(), starts.back().getRotation()).setFriction(btScalar(0.7));
    }
    world.run(5, 1.0 / 60);
    for (int i = 0; i < 5; ++i) {
      const btRigidBody& table = *world.bodies[std::size_t(1 + i)];
      const btVector3 moved = table.getWorldTransform().getOrigin() - starts[std::size_t(i)].getOrigin();
      EXPECT_LT(std::hypot(moved.x(), moved.y()), 0.01) << aside << ", table " << i;
      EXPECT_NEAR(moved.z(), -0.005 * (i + 1), 0.0025 * (i + 1)) << aside << ", table " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Responses, Stack,
                         testing::Combine(testing::Values(Response::compliant, Response::rigid),
                                          testing::Values(1.0 / 60, 1.0 / 240)));

}  // namespace
}  // namespace innersphere::test
