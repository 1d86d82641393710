// SubstepSolver with threads, without allocations, and the number of substeps that it chooses.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "../gpu/allocation_counter.hpp"
#include "solver/solver_world.hpp"

namespace innersphere::test {
namespace {

/// Whatever the machine has.
constexpr int kMostThreads = 16;

TEST(SubstepThreads, BitsAreTheSameForAnyNumber) {
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, kMostThreads);
  std::vector<btScalar> alone;
  for (const int threads : {1, 2, 8, kMostThreads}) {
    tbb::task_arena arena(threads);
    SolverWorld world;
    fill(world, 14, 4);
    arena.execute([&] { world.run(0.1); });
    if (threads == 1)
      alone = world.motion();
    else
      EXPECT_EQ(world.motion(), alone) << threads;
  }
}

TEST(SubstepAllocations, ThereAreNoneOnceThePileHasFormed) {
  tbb::task_arena arena(1);
  SolverWorld world;
  fill(world, 4, 3);
  arena.execute([&] {
    world.run(2);
    const std::size_t before = allocations();
    world.run(0.5);
    EXPECT_EQ(allocations(), before);
  });
}

TEST(SubstepCount, IsAsGivenOrFollowsStepAndMasses) {
  SolverWorld given(SubstepOptions{5});
  given.addBox(btVector3(1, 1, 1), 1, btVector3(0, 0, 0));
  EXPECT_EQ(given.solver.substeps(), 0);
  given.step();
  EXPECT_EQ(given.solver.substeps(), 5);
  int before = 0;
  for (const btScalar ratio : {1, 100, 400, 1000000}) {
    SolverWorld world;
    world.addFloor();
    world.addBox(btVector3(0.25f, 0.25f, 0.25f), 1, btVector3(0, 0, 0.25f));
    world.addBox(btVector3(0.25f, 0.25f, 0.25f), ratio, btVector3(0, 0, 0.75f));
    world.step();
    const int substeps = world.solver.substeps();
    EXPECT_TRUE(ratio > 1 || substeps == 16) << substeps;  // of 1/960 s
    EXPECT_GT(substeps, before);
    EXPECT_LE(substeps, SubstepOptions().most);
    before = substeps;
    if (substeps == SubstepOptions().most) continue;
    world.step(btScalar(1) / 240);
    EXPECT_LE(world.solver.substeps(), std::max(4, (substeps + 3) / 4));
  }
}

}  // namespace
}  // namespace innersphere::test
