// A world moves the same whichever backend its contacts come from.
#include <gtest/gtest.h>

#include <vector>

#include "device.hpp"
#include "named_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

std::vector<btTransform> fallenPile(Backend backend) {
  ContactOptions options;
  options.backend = backend;
  TestWorld world(options);
  world.addFloor();
  const std::shared_ptr<PackingShape> shapes[] = {makeNamedShape("torus", 500, 0.35),
                                                  makeNamedShape("nut", 500, 0.35)};
  for (int i = 0; i < 6; ++i) {
    const btQuaternion turn(btVector3(1, btScalar(0.4 * i), btScalar(0.3)).normalized(), btScalar(0.9 * i));
    world.add(shapes[i % 2], 1, btVector3(btScalar(0.05 * i), 0, btScalar(0.4 + 0.45 * i)), turn);
  }
  world.run(1.5, 1.0 / 120);  // long enough for all of them to hit each other
  EXPECT_GT(world.contactCount(), 6);
  std::vector<btTransform> places;
  for (const auto& body : world.bodies) places.push_back(body->getWorldTransform());
  return places;
}

TEST(BackendOfAWorld, CudaMovesBodiesAsTheCpuDoes) {
  needDevice();
  if (IsSkipped() || HasFatalFailure()) return;
  const std::vector<btTransform> cpu = fallenPile(Backend::cpu);
  const std::vector<btTransform> cuda = fallenPile(Backend::cuda);
  ASSERT_EQ(cpu.size(), cuda.size());
  for (std::size_t i = 0; i < cpu.size(); ++i) {
    EXPECT_LT(cpu[i].getOrigin().distance(cuda[i].getOrigin()), 1e-3) << i;
  }
}

}  // namespace
}  // namespace innersphere::test
