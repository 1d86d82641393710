// After warm-up a step allocates nothing on our side. (Bullet allocates with malloc, which is not counted.)
#include <gtest/gtest.h>

#include "bullet_shapes.hpp"
#include "gpu/allocation_counter.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

class Allocations : public testing::TestWithParam<std::string> {};

TEST_P(Allocations, NoneInAStep) {
  for (const DispatcherKind kind : {DispatcherKind::plain, DispatcherKind::batched}) {
    TestWorld world({}, kind);
    const BulletShape ground = makeBulletShape(GetParam());
    world.add(ground.shape, 0, ground.place.getOrigin(), ground.place.getRotation());
    const auto shape = makeShape(latticeBox({1, 1, 1}, 6));
    for (int i = 0; i < 3; ++i) {
      world.add(shape, 1, btVector3(0, 0, btScalar(0.5 + i))).setActivationState(DISABLE_DEACTIVATION);
    }
    const auto push = [&](int steps) {  // stays in contact, and moves
      for (int i = 0; i < steps; ++i) {
        world.bodies[2]->setAngularVelocity(btVector3(0, 0, btScalar(0.1)));
        world.run(1.0 / 240, 1.0 / 240);
      }
    };
    push(120);
    const std::size_t before = allocations();
    push(60);
    EXPECT_EQ(allocations() - before, 0u);
    EXPECT_GT(world.contactCount(), 4);
  }
}

INSTANTIATE_TEST_SUITE_P(Grounds, Allocations,
                         testing::Values("plane", "box", "sphere", "convex_hull", "triangle_mesh", "terrain",
                                         "packing", "nested_compound_of_a_packing"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace innersphere::test
