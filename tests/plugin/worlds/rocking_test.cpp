// Bodies that rock on each other are not driven by steps, and come to rest.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "innersphere/mesh.hpp"
#include "innersphere/substep_solver.hpp"
#include "named_packings.hpp"
#include "outline_meshes.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

/// With Bullet's solver, or with a SubstepSolver.
class Rocking : public testing::TestWithParam<bool> {
 protected:
  void prepare(TestWorld& world) {
    PackingCollisionAlgorithm::prepareWorld(world.world);
    if (GetParam()) world.world.setConstraintSolver(&substeps_);
  }

 private:
  SubstepSolver substeps_;
};

/// What is left of an amplitude of what swings at this rate [rad/s], after so many seconds.
double leftOf(double rate, double time_step, double seconds) {
  const double phase = rate * time_step;
  return std::exp(-phase * phase * rate * phase / 2 * seconds);
}

// A plate on a fixed ball of radius R, its centre h over the place and k its radius of gyration:
//   w^2 = g (R - h) / (k^2 + h^2).
// Amplitudes fall by (w dt)^2 w^2 dt / 2 in a second: what steps resolve rocks on. With the place at the end
// of the step they fell by w^2 dt / 2, and with an older one than that at its start they would grow.
TEST_P(Rocking, IsBrakedByTheThirdPowerOfTheStep) {
  constexpr double kBall = 1, kSide = 0.3, kHeight = 0.05, kTilt = 0.02, kSeconds = 1;
  constexpr double kHigh = kHeight / 2, kGyration2 = (kSide * kSide + kHeight * kHeight) / 12;
  const double rate = std::sqrt(9.81 * (kBall - kHigh) / (kGyration2 + kHigh * kHigh)), swing = M_PI / rate;
  for (const double steps : {120.0, 240.0, 960.0}) {
    TestWorld world;
    prepare(world);
    world.add(makeFineBallShape(kBall, 500), 0, btVector3(0, 0, btScalar(-kBall)));
    btRigidBody& plate = world.add(makeShape(latticeBox({kSide, kSide, kHeight}, 6)), 1,
                                   btVector3(0, 0, btScalar(kHeight / 2)));
    plate.setActivationState(DISABLE_DEACTIVATION);
    world.run(0.2, 1 / steps);
    plate.setAngularVelocity(btVector3(0, btScalar(kTilt * rate), 0));
    plate.setLinearVelocity(btVector3(btScalar(kTilt * rate * kHigh), 0, 0));
    const auto fastest = [&] {
      double most = 0;
      for (double t = 0; t < swing; t += 1 / steps) {
        world.run(1 / steps, 1 / steps);
        most = std::max(most, double(plate.getAngularVelocity().length()));
      }
      return most;
    };
    const double before = fastest();
    world.run(kSeconds - swing, 1 / steps);
    const double expected = leftOf(rate, 1 / steps, kSeconds);
    EXPECT_NEAR(fastest() / before, expected, 0.1 * expected) << steps << " steps/s";
  }
}

// As a chair does, on arcs of radii below and above its size: by the same law, with gyration about the place.
TEST_P(Rocking, OfRockersGoesOn) {
  constexpr double kWide = 1, kHigh = 0.3, kTilt = 0.05, kSeconds = 4, kSides = 64;
  for (const double radius : {0.8, 1.0, 1.5}) {
    std::vector<std::array<double, 2>> outline;
    const double end = std::asin(kWide / 2 / radius);
    for (int i = 0; i <= kSides; ++i) {
      const double angle = end * (2 * i / kSides - 1);
      outline.push_back({radius * std::sin(angle), radius - radius * std::cos(angle)});
    }
    outline.push_back({kWide / 2, kHigh});
    outline.push_back({-kWide / 2, kHigh});
    const auto solid = makeSolid(prismMesh(outline), "rocker");
    const MassProperties mass = solid->massProperties();
    const double height = mass.centre_of_mass[2], gyration2 = mass.inertia[4] / mass.volume;
    const double rate = std::sqrt(9.81 * (radius - height) / (gyration2 + height * height));
    const auto shape = makePackedShape(*solid, 1000);
    for (const double steps : {60.0, 240.0}) {
      TestWorld world;
      prepare(world);
      world.addFloor();
      const btQuaternion tilted(btVector3(0, 1, 0), btScalar(kTilt));
      const btVector3 centre(0, 0, btScalar(radius));
      const btTransform start =
          shape->bodyTransform(btTransform(tilted, centre - quatRotate(tilted, centre)));
      btRigidBody& rocker = world.add(shape, 1, start.getOrigin(), start.getRotation());
      rocker.setFriction(1);
      rocker.setActivationState(DISABLE_DEACTIVATION);
      world.run(kSeconds, 1 / steps);
      double farthest = 0;
      for (double t = 0; t < 2 * M_PI / rate; t += 1 / steps) {
        world.run(1 / steps, 1 / steps);
        const btMatrix3x3 axes = shape->meshTransform(rocker.getWorldTransform()).getBasis();
        farthest = std::max(farthest, std::abs(std::atan2(double(axes[0].z()), double(axes[2].z()))));
      }
      const double expected = kTilt * leftOf(rate, 1 / steps, kSeconds);
      EXPECT_NEAR(farthest, expected, 0.1 * expected) << radius << " m, " << steps << " steps/s";
    }
  }
}

// Their tubes are nearly parallel, and touch in two places that run along them ten times as fast as the rings
// move.
TEST_P(Rocking, OfRingsEnds) {
  TestWorld world;
  prepare(world);
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
