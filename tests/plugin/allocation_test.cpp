// After warm-up a step allocates nothing on our side. (Bullet allocates with malloc, which is not counted.)
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "bullet_shapes.hpp"
#include "gpu/allocation_counter.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

class Allocations : public testing::TestWithParam<std::string> {};

TEST_P(Allocations, NoneInAStep) {
  // Each thread has scratch memory of its own and warms up when it first gets work, whenever that is.
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  for (const DispatcherKind kind : {DispatcherKind::plain, DispatcherKind::batched}) {
    TestWorld world({}, kind);
    const BulletShape ground = makeBulletShape(GetParam());
    world.add(ground.shape, 0, ground.place.getOrigin(), ground.place.getRotation());
    const auto shape = makeShape(latticeBox({1, 1, 1}, 6));
    for (int i = 0; i < 3; ++i) {
      world.add(shape, 1, btVector3(0, 0, btScalar(0.5 + i))).setActivationState(DISABLE_DEACTIVATION);
    }
    const auto turn = [&](int steps, double spin) {  // stays in contact, and moves
      for (int i = 0; i < steps; ++i) {
        world.bodies[2]->setAngularVelocity(btVector3(0, 0, btScalar(spin)));
        world.run(1.0 / 240, 1.0 / 240);
      }
    };
    // There and back, so that the steps that count have no more contacts than those before.
    turn(120, 0.1);
    turn(120, -0.1);
    const std::size_t before = allocations();
    turn(60, 0.1);
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
