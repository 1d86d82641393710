// After warm-up a step allocates nothing.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <string>
#include <tuple>

#include <LinearMath/btAlignedAllocator.h>
#include <tbb/global_control.h>

#include "bullet_shapes.hpp"
#include "gpu/allocation_counter.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

/// Counts what Bullet's arrays take, its own and ours, while it lives.
class BulletAllocations {
 public:
  BulletAllocations() {
    count_ = 0;
    btAlignedAllocSetCustom(take, std::free);
  }
  ~BulletAllocations() { btAlignedAllocSetCustom(nullptr, nullptr); }
  static std::size_t count() { return count_; }

 private:
  static void* take(std::size_t size) {
    ++count_;
    return std::malloc(size);
  }
  static inline std::atomic<std::size_t> count_{0};
};

class Allocations : public testing::TestWithParam<std::tuple<std::string, Response, DispatcherKind>> {};

TEST_P(Allocations, NoneInAStep) {
  const auto& [name, response, kind] = GetParam();
  // Each thread has scratch memory of its own and warms up when it first gets work, whenever that is.
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const BulletAllocations of_bullet;
  ContactOptions options;
  options.response = response;
  TestWorld world(options, kind);
  const BulletShape ground = makeBulletShape(name);
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
  EXPECT_GT(of_bullet.count(), 0u) << "is not counted";
  const std::size_t before = allocations(), before_of_bullet = of_bullet.count();
  turn(60, 0.1);
  EXPECT_EQ(allocations() - before, 0u);
  EXPECT_EQ(of_bullet.count() - before_of_bullet, 0u);
  EXPECT_GT(world.contactCount(), 4);
}

std::string nameOfCase(const testing::TestParamInfo<Allocations::ParamType>& info) {
  const auto& [name, response, kind] = info.param;
  return name + "_" + nameOf(response) + "_" + nameOf(kind);
}

INSTANTIATE_TEST_SUITE_P(
    Grounds, Allocations,
    testing::Combine(testing::Values("plane", "box", "sphere", "convex_hull", "triangle_mesh", "terrain",
                                     "packing", "nested_compound_of_a_packing"),
                     testing::Values(Response::compliant, Response::rigid, Response::penalty),
                     testing::Values(DispatcherKind::plain, DispatcherKind::batched)),
    nameOfCase);

}  // namespace
}  // namespace innersphere::test
