// Bodies that rock on each other are not driven by steps, and come to rest.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "innersphere/substep_solver.hpp"
#include "named_packings.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

/// With Bullet's solver, or with a SubstepSolver.
class Rocking : public testing::TestWithParam<bool> {
 protected:
  Rocking() {
    PackingCollisionAlgorithm::prepareWorld(world.world);
    if (GetParam()) world.world.setConstraintSolver(&substeps_);
  }

 private:
  SubstepSolver substeps_;

 protected:
  TestWorld world;
};

// A plate on a fixed ball of radius R, its centre h over the place and k its radius of gyration:
//   w^2 = g (R - h) / (k^2 + h^2).
// With the place at the end of the step amplitudes fall by w^2 dt / 2 in a second, with that at its start not
// at all, and with an older one they grow.
TEST_P(Rocking, IsBrakedAsByBackwardEuler) {
  constexpr double kBall = 1, kSide = 0.3, kHeight = 0.05, kTilt = 0.02, kStep = 1.0 / 960, kSeconds = 1;
  world.add(makeFineBallShape(kBall, 500), 0, btVector3(0, 0, btScalar(-kBall)));
  btRigidBody& plate =
      world.add(makeShape(latticeBox({kSide, kSide, kHeight}, 6)), 1, btVector3(0, 0, btScalar(kHeight / 2)));
  plate.setActivationState(DISABLE_DEACTIVATION);
  world.run(0.2, kStep);
  constexpr double kHigh = kHeight / 2, kGyration2 = (kSide * kSide + kHeight * kHeight) / 12;
  const double rate = std::sqrt(9.81 * (kBall - kHigh) / (kGyration2 + kHigh * kHigh));
  plate.setAngularVelocity(btVector3(0, btScalar(kTilt * rate), 0));
  plate.setLinearVelocity(btVector3(btScalar(kTilt * rate * kHigh), 0, 0));
  const double swing = M_PI / rate;
  const auto fastest = [&] {
    double most = 0;
    for (double t = 0; t < swing; t += kStep) {
      world.run(kStep, kStep);
      most = std::max(most, double(plate.getAngularVelocity().length()));
    }
    return most;
  };
  const double before = fastest();
  world.run(kSeconds - swing, kStep);
  const double expected = std::exp(-rate * rate * kStep / 2 * kSeconds);
  EXPECT_NEAR(fastest() / before, expected, 0.1 * expected);
}

// Their tubes are nearly parallel, and touch in two places that run along them ten times as fast as the rings
// move.
TEST_P(Rocking, OfRingsEnds) {
  const auto ring = makeTorusShape(1, 0.3, 1000);
  world.add(ring, 0, btVector3(0, 0, 0));
  world.add(ring, 1, btVector3(btScalar(0.2), 0, btScalar(0.62))).setActivationState(DISABLE_DEACTIVATION);
  world.run(30);
  double most = 0;
  for (int i = 0; i < 60; ++i) {
    world.run(1.0 / 60);
    most = std::max(most, world.kineticEnergy());
  }
  EXPECT_LT(most, 1e-3);  // as tops jump between triangles up to 4e-4 may be left
}

INSTANTIATE_TEST_SUITE_P(Solvers, Rocking, testing::Bool(),
                         [](const auto& info) { return info.param ? "SubstepSolver" : "Bullet"; });

}  // namespace
}  // namespace innersphere::test
