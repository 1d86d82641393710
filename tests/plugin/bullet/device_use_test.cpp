// Nobody calls CUDA, or takes memory of a device, that no pair asks for.
#include <gtest/gtest.h>

#include "device.hpp"
#include "gpu/cuda/cuda_calls.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

using Shape = std::shared_ptr<PackingShape>;

std::shared_ptr<const CollisionModel> cubeOf(int n) {
  return std::make_shared<CollisionModel>(std::make_shared<const Packing>(latticeBox({1, 1, 1}, n)));
}

struct Calls {
  std::size_t all = 0, allocations = 0;
};

/// In a short life of a world where one body lies on the other, or beside it.
Calls callsOfAWorld(Backend backend, const Shape& lower, const Shape& upper, double apart = 0.98) {
  const Calls before{cudaCalls(), cudaAllocations()};
  ContactOptions options;
  options.backend = backend;
  TestWorld world(options);
  world.add(lower, 0, btVector3(0, 0, 0));
  world.add(upper, 1, btVector3(0, 0, btScalar(apart)));
  world.run(0.1);
  EXPECT_EQ(world.contactCount() > 0, apart < 1);
  return {cudaCalls() - before.all, cudaAllocations() - before.allocations};
}

TEST(DeviceUse, NoneOnTheCpu) {
  const auto shape = makeShape(latticeBox({1, 1, 1}, 32));
  EXPECT_EQ(callsOfAWorld(Backend::cpu, shape, shape).all, 0u);
}

TEST(DeviceUse, NoneForFewSpheres) {
  const auto shape = makeShape(latticeBox({1, 1, 1}, 4));
  EXPECT_EQ(callsOfAWorld(Backend::automatic, shape, shape).all, 0u);
}

TEST(DeviceUse, NoneForBodiesThatDoNotMeet) {
  const auto shape = makeShape(latticeBox({1, 1, 1}, 32));
  EXPECT_EQ(callsOfAWorld(Backend::automatic, shape, shape, 5).all, 0u);
}

/// Many spheres look for a device, whether there is one or not.
TEST(DeviceUse, IsCounted) {
  const auto shape = makeShape(latticeBox({1, 1, 1}, 32));
  EXPECT_GT(callsOfAWorld(Backend::automatic, shape, shape).all, 0u);
}

class UseOfADevice : public testing::Test {
 protected:
  void SetUp() override { needDevice(); }
};

TEST_F(UseOfADevice, BodiesThatDoNotMeetTakeNoMemory) {
  const auto shape = makeShape(latticeBox({1, 1, 1}, 16));
  EXPECT_EQ(callsOfAWorld(Backend::cuda, shape, shape, 5).allocations, 0u);
  EXPECT_GT(callsOfAWorld(Backend::cuda, shape, shape).allocations, 0u);
}

/// What else a world takes does not depend on whose shapes they are.
TEST_F(UseOfADevice, ShapesOfAModelAreInItsMemoryOnce) {
  const auto allocations = [](const std::shared_ptr<const CollisionModel>& lower,
                              const std::shared_ptr<const CollisionModel>& upper) {
    return callsOfAWorld(Backend::cuda, std::make_shared<PackingShape>(lower),
                         std::make_shared<PackingShape>(upper))
        .allocations;
  };
  allocations(cubeOf(16), cubeOf(16));  // what a process takes once
  const auto model = cubeOf(16), same = cubeOf(16);
  const Shape shape = std::make_shared<PackingShape>(same);
  const std::size_t of_one_shape = callsOfAWorld(Backend::cuda, shape, shape).allocations;
  EXPECT_EQ(allocations(model, model), of_one_shape);
  const PackingShape kept(model);  // what shapes search with lives as long as one of them
  allocations(model, model);
  EXPECT_LT(allocations(model, model), of_one_shape);  // it is there already
  EXPECT_GT(allocations(cubeOf(16), cubeOf(16)), of_one_shape);
}

}  // namespace
}  // namespace innersphere::test
