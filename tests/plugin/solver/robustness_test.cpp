// SubstepSolver with input that is wrong or large, with threads, and without allocations.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include "../gpu/allocation_counter.hpp"
#include "capture_log.hpp"
#include "innersphere/error.hpp"
#include "solver/solver_world.hpp"

namespace innersphere::test {
namespace {

constexpr btScalar kInfinity = std::numeric_limits<btScalar>::infinity();
constexpr btScalar kNan = std::numeric_limits<btScalar>::quiet_NaN();

/// Boxes that lie in layers, and a chain of hinges over them.
void fill(SolverWorld& world, int across, int layers) {
  world.addFloor();
  for (int z = 0; z < layers; ++z) {
    for (int x = 0; x < across; ++x) {
      for (int y = 0; y < across; ++y) {
        const btScalar shift = btScalar(0.1) * btScalar(z % 2);
        world.addBox(btVector3(0.2f, 0.2f, 0.2f), 1,
                     btVector3(btScalar(0.41) * btScalar(x) + shift, btScalar(0.41) * btScalar(y) + shift,
                               btScalar(0.2) + btScalar(0.4) * btScalar(z)));
      }
    }
  }
  btRigidBody* above = nullptr;
  for (int i = 0; i < 8; ++i) {
    btRigidBody& link =
        world.addBox(btVector3(0.1f, 0.05f, 0.05f), 1, btVector3(btScalar(0.2) * btScalar(i), 0, 9));
    if (above != nullptr)
      world.join<btHingeConstraint>(*above, link, btVector3(0.1f, 0, 0), btVector3(-0.1f, 0, 0),
                                    btVector3(0, 1, 0), btVector3(0, 1, 0));
    above = &link;
  }
}

TEST(SubstepThreads, BitsAreTheSameForAnyNumber) {
  std::vector<btScalar> alone;
  for (const int threads : {1, 2, 8}) {
    tbb::task_arena arena(threads);
    SolverWorld world;
    fill(world, 8, 4);
    arena.execute([&] { world.run(0.5); });
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

TEST(SubstepInput, BodiesWithoutNumbersStandStillAndTouchNothing) {
  for (const btScalar bad : {kInfinity, kNan}) {
    SolverWorld world;
    CaptureLog log;
    world.addFloor();
    const btRigidBody& sound = world.addBox(btVector3(0.25f, 0.25f, 0.25f), 1, btVector3(0, 0, 0.25f));
    btRigidBody& broken = world.addBox(btVector3(0.25f, 0.25f, 0.25f), 1, btVector3(0, 0, 0.75f));
    world.run(0.2);
    broken.setLinearVelocity(btVector3(0, bad, 0));
    btCollisionObject* bodies[] = {world.bodies[1].get(), &broken};
    btPersistentManifold* manifolds[] = {world.dispatcher.getManifoldByIndexInternal(0),
                                         world.dispatcher.getManifoldByIndexInternal(1)};
    btContactSolverInfo info;
    for (int i = 0; i < 3; ++i)
      world.solver.solveGroup(bodies, 2, manifolds, 2, nullptr, 0, info, nullptr, &world.dispatcher);
    EXPECT_TRUE(std::isfinite(sound.getWorldTransform().getOrigin().length()));
    EXPECT_TRUE(std::isfinite(sound.getLinearVelocity().length()));
    EXPECT_EQ(log.messages.size(), 1u);
  }
}

TEST(SubstepInput, PointsWithoutNumbersAreLeftOut) {
  SolverWorld world;
  CaptureLog log;
  world.addFloor();
  btRigidBody& box = world.addBox(btVector3(0.25f, 0.25f, 0.25f), 1, btVector3(0, 0, 0.25f));
  world.run(0.2);
  btPersistentManifold* manifold = world.dispatcher.getManifoldByIndexInternal(0);
  manifold->getContactPoint(0).m_normalWorldOnB = btVector3(kNan, 0, 0);
  btCollisionObject* body = &box;
  world.solver.solveGroup(&body, 1, &manifold, 1, nullptr, 0, btContactSolverInfo(), nullptr,
                          &world.dispatcher);
  EXPECT_TRUE(std::isfinite(box.getLinearVelocity().length()));
  EXPECT_EQ(log.messages.size(), 1u);
}

TEST(SubstepInput, BodiesWithoutInertiaMoveButDoNotTurn) {
  SolverWorld world;
  world.addFloor();
  auto shape = std::make_unique<btBoxShape>(btVector3(0.25f, 0.25f, 0.25f));
  btRigidBody& box = world.add(std::move(shape), 1, btVector3(0, 0, 1));
  box.setMassProps(1, btVector3(0, 0, 0));
  box.updateInertiaTensor();
  world.run(2);
  EXPECT_NEAR(box.getWorldTransform().getOrigin().z(), 0.25, 0.001);
  EXPECT_EQ(box.getAngularVelocity().length(), 0);
}

TEST(SubstepInput, AStepOfNothingDoesNothing) {
  SolverWorld world;
  btRigidBody& box = world.addBox(btVector3(0.25f, 0.25f, 0.25f), 1, btVector3(0, 0, 1));
  box.setLinearVelocity(btVector3(1, 0, 0));
  btCollisionObject* body = &box;
  btContactSolverInfo info;
  info.m_timeStep = 0;
  world.solver.solveGroup(&body, 1, nullptr, 0, nullptr, 0, info, nullptr, &world.dispatcher);
  world.solver.solveGroup(nullptr, 0, nullptr, 0, nullptr, 0, btContactSolverInfo(), nullptr,
                          &world.dispatcher);
  EXPECT_EQ(box.getWorldTransform().getOrigin(), btVector3(0, 0, 1));
  EXPECT_EQ(box.getLinearVelocity(), btVector3(1, 0, 0));
}

TEST(SubstepInput, OneSolverServesTwoWorlds) {
  SolverWorld first, second, alone;
  second.world.setConstraintSolver(&first.solver);
  for (SolverWorld* world : {&first, &second, &alone}) fill(*world, 2, 2);
  for (int i = 0; i < 60; ++i) {
    first.step();
    second.step();
    alone.step();
  }
  EXPECT_EQ(first.motion(), alone.motion());
  EXPECT_EQ(second.motion(), alone.motion());
}

TEST(SubstepInput, AMultiBodyWorldIsNamed) {
  CaptureLog log;
  SolverWorld parts;
  btMultiBodyConstraintSolver own;
  btMultiBodyDynamicsWorld world(&parts.dispatcher, &parts.broadphase, &own, &parts.configuration);
  world.setConstraintSolver(&parts.solver);
  for (int i = 0; i < 3; ++i) world.stepSimulation(btScalar(1) / 60, 0);
  ASSERT_EQ(log.messages.size(), 1u);
  EXPECT_NE(log.messages[0].find("btMultiBodyConstraintSolver"), std::string::npos);
  parts.world.stepSimulation(btScalar(1) / 60, 0);
  EXPECT_EQ(log.messages.size(), 1u);
}

TEST(SubstepInput, OptionsOutOfRangeAreErrors) {
  for (const SubstepOptions& options :
       {SubstepOptions{-1}, SubstepOptions{1001}, SubstepOptions{0, 0}, SubstepOptions{0, kNan},
        SubstepOptions{0, btScalar(0.001), 0}, SubstepOptions{0, btScalar(0.001), btScalar(0.001), 0}})
    EXPECT_THROW(SubstepSolver{options}, Error);
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
