// Contacts follow the settings of the world's solver.
#include "response/solver_settings.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "innersphere/packing_collision_algorithm.hpp"
#include "response/contact_law.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

TEST(SolverSettings, DefaultsAreBullets) {
  const SolverSettings defaults, found{btContactSolverInfo()};
  EXPECT_NEAR(found.warm_starting, defaults.warm_starting, 1e-6);
  EXPECT_NEAR(found.friction_erp, defaults.friction_erp, 1e-6);
  EXPECT_NEAR(found.deepest_spring, defaults.deepest_spring, 1e-6);
}

TEST(SolverSettings, WithoutWarmStartingOrSplitImpulseThereIsNone) {
  btContactSolverInfo info;
  info.m_solverMode &= ~SOLVER_USE_WARMSTARTING;
  info.m_splitImpulse = false;
  EXPECT_EQ(SolverSettings(info).warm_starting, 0);
  EXPECT_EQ(SolverSettings(info).deepest_spring, BT_LARGE_FLOAT);
}

/// A spring that would be deeper than the threshold is told a smaller depth, with the same force.
TEST(SolverSettings, ASpringStaysAboveTheThresholdOfSplitImpulses) {
  btContactSolverInfo info;
  info.m_splitImpulsePenetrationThreshold = btScalar(-0.4);
  ContactOptions options;
  options.stiffness = 1000;
  ContactPatch patch;
  patch.normal = btVector3(0, 0, 1);
  patch.area = 1;
  patch.count = 1;
  const std::vector<ContactPatch> patches{patch};
  const auto at = [&](const SolverSettings& solver, double depth) {
    return ContactLaw(options, 1, btScalar(0.01), 1, solver).of(patches, 0).at(btScalar(depth));
  };
  for (const double depth : {0.01, 0.1, 0.25, 1.0}) {
    const PointLaw near = at({}, depth), far = at(SolverSettings(info), depth);
    EXPECT_NEAR(near.depth, std::min(depth, 0.03), 1e-6);
    EXPECT_NEAR(far.depth, std::min(depth, 0.3), 1e-6);
    EXPECT_NEAR(near.stiffness * near.depth, 1000 * depth, 1e-3 * depth);
    EXPECT_NEAR(far.stiffness * far.depth, 1000 * depth, 1e-3 * depth);
  }
}

/// Bullet's friction anchors undo the part e of a slip in a step by the impulse m e s / dt.
TEST(SolverSettings, ASlipThatFrictionUndoesFollowsTheFrictionErp) {
  btContactSolverInfo info;
  const auto slip = [&](double erp) {
    info.m_frictionERP = btScalar(erp);
    const std::vector<ContactPatch> patches(1);
    return ContactLaw({}, 2, btScalar(0.01), 1, SolverSettings(info)).of(patches, 0).slipUndoneBy(3);
  };
  for (const double erp : {0.1, 0.2, 0.8}) EXPECT_NEAR(slip(erp), 3 * 0.01 / (erp * 2), 1e-6);
  EXPECT_EQ(slip(0), 0);
}

/// A box on a plane under a spring bears its weight whatever part of its impulse the solver starts with; a
/// law for another solver would let it sink until its spring has made up for the difference.
TEST(SolverSettings, AWorldThatIsRegisteredIsRead) {
  const auto sinking = [](bool of_world, double warm_starting) {
    TestWorld world;
    world.world.getSolverInfo().m_warmstartingFactor = btScalar(warm_starting);
    if (of_world) PackingCollisionAlgorithm::registerAlgorithm(world.world);
    world.addFloor();
    btRigidBody& box = world.add(makeShape(latticeBox({1, 1, 1}, 6)), 1, btVector3(0, 0, btScalar(0.5)));
    box.setActivationState(DISABLE_DEACTIVATION);
    world.run(2);
    return 0.5 - box.getWorldTransform().getOrigin().z();
  };
  const double expected = sinking(false, 0.85);
  EXPECT_NEAR(sinking(true, 0.85), expected, 1e-6);
  for (const double factor : {0.5, 0.2}) EXPECT_NEAR(sinking(true, factor), expected, 2e-5) << factor;
}

}  // namespace
}  // namespace innersphere::test
