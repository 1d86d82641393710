// Machines with joints under SubstepSolver, at 60 steps a second.
#include <gtest/gtest.h>

#include "solver/machines.hpp"

namespace innersphere::test {
namespace {

TEST(SubstepMachines, AChainOfHingesHangsAsLongAsItIs) {
  for (const btScalar load : {1, 100}) {
    SolverWorld world;
    constexpr int kLinks = 20;
    const btRigidBody& last = hangChain(world, kLinks, load);
    world.run(5);
    EXPECT_NEAR(last.getWorldTransform().getOrigin().z(), chainEnd(kLinks), 0.001 * 0.5 * kLinks) << load;
    EXPECT_LT(last.getLinearVelocity().length(), 1e-3) << load;
  }
}

TEST(SubstepMachines, AMotorLiftsItsLoadAndHoldsIt) {
  SolverWorld world;
  MotorArm machine(world);
  constexpr double kStep = 1.0 / 60;
  machine.turn(1, kStep);
  world.run(1);
  EXPECT_NEAR(machine.angle(), MotorArm::kAngle, 0.003);
  const double reached = machine.angle();
  machine.turn(0, kStep);
  world.run(3);
  EXPECT_NEAR(machine.angle(), reached, 0.05);
  const double held = machine.angle();
  world.run(3);
  EXPECT_NEAR(machine.angle(), held, 1e-3);
  EXPECT_LT(machine.gap(), 1e-3);
}

TEST(SubstepMachines, ARagdollKeepsItsJointsAndComesToRest) {
  SolverWorld world;
  world.addFloor();
  Ragdoll ragdoll(world, btScalar(0.5));
  EXPECT_LT(ragdoll.gap(), 1e-6);
  EXPECT_LT(ragdoll.beyond(), 1e-3);
  const double before = world.energy();
  double gap = 0, beyond = 0, most = before;
  for (int i = 0; i < 600; ++i) {
    world.step();
    gap = std::max(gap, ragdoll.gap());
    beyond = std::max(beyond, ragdoll.beyond());
    most = std::max(most, world.energy());
  }
  EXPECT_LT(gap, 0.01);
  EXPECT_LT(beyond, 0.2);
  EXPECT_LT(ragdoll.gap(), 0.001);
  EXPECT_LT(ragdoll.beyond(), 0.02);
  EXPECT_LT(ragdoll.fastest(), 0.01);
  EXPECT_LT(most, before * 1.001);
}

}  // namespace
}  // namespace innersphere::test
