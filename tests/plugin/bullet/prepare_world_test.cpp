// One line does what a world needs, and the log says if it was forgotten.
#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "capture_log.hpp"
#include "innersphere/contact_statistics.hpp"
#include "innersphere/error.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kHalf = 0.25;  // [m] of a cube

std::shared_ptr<PackingShape> cube() {
  return makeShape(latticeBox({2 * kHalf, 2 * kHalf, 2 * kHalf}, 6));
}

TEST(PrepareWorld, RegistersWithOptionsAndChangesOneBitOfTheMode) {
  TestWorld world;
  PackingCollisionAlgorithm::unregisterAlgorithm(&world.dispatcher);
  const btContactSolverInfo before = world.world.getSolverInfo();
  ASSERT_EQ(before.m_solverMode & SOLVER_USE_2_FRICTION_DIRECTIONS, 0);
  ContactOptions options;
  options.stiffness = 321;
  PackingCollisionAlgorithm::prepareWorld(world.world, options);
  EXPECT_TRUE(PackingCollisionAlgorithm::isRegistered(&world.dispatcher));
  EXPECT_EQ(PackingCollisionAlgorithm::options(&world.dispatcher).stiffness, 321);
  EXPECT_EQ(world.world.getSolverInfo().m_solverMode, before.m_solverMode | SOLVER_USE_2_FRICTION_DIRECTIONS);
  EXPECT_EQ(world.world.getSolverInfo().m_numIterations, before.m_numIterations);
  PackingCollisionAlgorithm::prepareWorld(world.world);
  EXPECT_EQ(PackingCollisionAlgorithm::options(&world.dispatcher).stiffness, ContactOptions().stiffness);
  EXPECT_EQ(world.world.getSolverInfo().m_solverMode, before.m_solverMode | SOLVER_USE_2_FRICTION_DIRECTIONS);
}

TEST(PrepareWorld, BadOptionsLeaveTheMode) {
  TestWorld world;
  ContactOptions options;
  options.stiffness = -1;
  const int before = world.world.getSolverInfo().m_solverMode;
  EXPECT_THROW(PackingCollisionAlgorithm::prepareWorld(world.world, options), Error);
  EXPECT_EQ(world.world.getSolverInfo().m_solverMode, before);
}

/// A cube of 1 kg hangs between two that are pressed together by 20 N, on rails that keep them level. All of
/// them feel gravity, so that they do not slide on each other before contacts push.
class Grip {
 public:
  explicit Grip(bool of_packings) {
    world.world.getSolverInfo().m_solverMode &= ~SOLVER_USE_2_FRICTION_DIRECTIONS;
    const auto shape = [&]() -> std::shared_ptr<btCollisionShape> {
      if (of_packings) return cube();
      return std::make_shared<btBoxShape>(btVector3(1, 1, 1) * btScalar(kHalf));
    };
    for (const double side : {-1.0, 0.0, 1.0}) {
      btRigidBody& body = world.add(shape(), 1, btVector3(btScalar(side * 2 * kHalf), 0, 0));
      body.setFriction(1);
      body.setActivationState(DISABLE_DEACTIVATION);
    }
    for (const std::size_t jaw : {0u, 2u}) {
      btTransform frame = btTransform::getIdentity();
      rails_[jaw / 2] = std::make_unique<btGeneric6DofConstraint>(*world.bodies[jaw], frame, true);
      rails_[jaw / 2]->setLinearLowerLimit(btVector3(-1, 0, 0));
      rails_[jaw / 2]->setLinearUpperLimit(btVector3(1, 0, 0));
      rails_[jaw / 2]->setAngularLowerLimit(btVector3(0, 0, 0));
      rails_[jaw / 2]->setAngularUpperLimit(btVector3(0, 0, 0));
      world.world.addConstraint(rails_[jaw / 2].get());
    }
  }
  ~Grip() {
    for (const auto& rail : rails_) world.world.removeConstraint(rail.get());
  }
  /// Presses for a second, and returns how far the middle one has gone down against the others [m].
  double slip() {
    for (int step = 0; step < 60; ++step) {
      world.bodies[0]->applyCentralForce(btVector3(20, 0, 0));
      world.bodies[2]->applyCentralForce(btVector3(-20, 0, 0));
      world.run(1.0 / 60);
    }
    const auto height = [&](std::size_t i) { return world.bodies[i]->getWorldTransform().getOrigin().z(); };
    return (height(0) + height(2)) / 2 - height(1);
  }
  TestWorld world;

 private:
  std::array<std::unique_ptr<btGeneric6DofConstraint>, 2> rails_;
};

TEST(PrepareWorld, WhatIsGrippedHolds) {
  for (const bool of_packings : {true, false}) {
    Grip prepared(of_packings), plain(of_packings);
    PackingCollisionAlgorithm::prepareWorld(prepared.world.world);
    EXPECT_NEAR(prepared.slip(), 0, 0.002) << of_packings;
    EXPECT_GT(plain.slip(), 0.02) << of_packings;  // what it is for
  }
}

class SolverLog : public testing::TestWithParam<DispatcherKind> {
 protected:
  SolverLog() : world({}, GetParam()) {
    world.addFloor();
    world.add(cube(), 1, btVector3(0, 0, btScalar(kHalf + 0.1)));
  }
  TestWorld world;
  CaptureLog log;
};

TEST_P(SolverLog, SaysOnceInTheStepThatBringsContact) {
  PackingCollisionAlgorithm::registerAlgorithm(world.world);
  while (world.contactCount() == 0) {
    ASSERT_TRUE(log.messages.empty());
    world.run(1.0 / 60);
  }
  ASSERT_EQ(log.messages.size(), 1u);
  EXPECT_NE(log.messages[0].find("prepareWorld"), std::string::npos) << log.messages[0];
  world.add(cube(), 1, btVector3(2, 0, btScalar(kHalf)));
  world.run(1);
  EXPECT_EQ(log.messages.size(), 1u);
  PackingCollisionAlgorithm::registerAlgorithm(world.world);
  for (const auto& body : world.bodies) body->activate();
  world.run(1);
  EXPECT_EQ(log.messages.size(), 2u);
}

TEST_P(SolverLog, SaysNothingOfAWorldThatIsPrepared) {
  PackingCollisionAlgorithm::prepareWorld(world.world);
  world.run(1);
  EXPECT_GT(world.contactCount(), 0);
  EXPECT_TRUE(log.messages.empty());
}

/// The mode may be set by hand, before or after.
TEST_P(SolverLog, LooksAtTheModeWhenBodiesTouch) {
  PackingCollisionAlgorithm::registerAlgorithm(world.world);
  world.run(1.0 / 60);
  ASSERT_EQ(world.contactCount(), 0);
  world.world.getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  world.run(1);
  EXPECT_GT(world.contactCount(), 0);
  EXPECT_TRUE(log.messages.empty());
}

TEST_P(SolverLog, SaysNothingWhereTheSolverIsNotKnown) {
  world.run(1);
  EXPECT_GT(world.contactCount(), 0);
  EXPECT_TRUE(log.messages.empty());
}

TEST_P(SolverLog, SaysNothingWhereNothingRubs) {
  PackingCollisionAlgorithm::registerAlgorithm(world.world);
  world.bodies.back()->setFriction(0);
  world.run(1);
  EXPECT_GT(world.contactCount(), 0);
  EXPECT_TRUE(log.messages.empty());
  world.add(cube(), 1, btVector3(2, 0, btScalar(kHalf)));  // it does
  world.run(1);
  EXPECT_EQ(log.messages.size(), 1u);
}

TEST_P(SolverLog, SaysNothingOfPenaltyForces) {
  ContactOptions options;
  options.response = Response::penalty;
  PackingCollisionAlgorithm::registerAlgorithm(world.world, options);
  world.run(1);
  EXPECT_GT(world.contactCount(), 0);
  EXPECT_TRUE(log.messages.empty());
}

/// Who hears of it may ask the plug-in something, which has finished what it was at.
TEST_P(SolverLog, MayAskThePlugIn) {
  PackingCollisionAlgorithm::registerAlgorithm(world.world);
  std::uint64_t searched = 0;
  setLogCallback([&](const std::string&) { searched = contactStatistics(&world.dispatcher).searched; });
  world.run(1);
  EXPECT_GT(searched, 0u);
}

INSTANTIATE_TEST_SUITE_P(Of, SolverLog,
                         testing::Values(DispatcherKind::plain, DispatcherKind::multithreaded,
                                         DispatcherKind::batched, DispatcherKind::batched_multithreaded),
                         [](const auto& info) { return nameOf(info.param); });

}  // namespace
}  // namespace innersphere::test
