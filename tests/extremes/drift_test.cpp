// A million steps: a ball that bounces about in a cage, both free in space, pushed by penalty forces alone.
// In single precision, where rounding decides, momentum stays what it was to 1e-4 (measured: 2.5e-5), angular
// momentum to 1e-3 (3e-4), and energy, looked at where the two do not touch, to 1e-3 (3e-4); in double
// precision to 1e-12, 1e-10 (momenta: 4e-14 and 1e-12) and 1e-4 (energy: 1e-5, the error of the steps).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "innersphere/pair_overlaps.hpp"
#include "watched_world.hpp"

namespace innersphere::test {
namespace {

/// The outermost layer of a lattice: a closed box of spheres.
Packing cageOf(int n) {
  Packing cage = withoutSurface(latticeBox({1, 1, 1}, n));
  const float wall = 0.5f - 0.75f / static_cast<float>(n);
  std::erase_if(cage.spheres, [wall](const Sphere& s) {
    return std::max({std::fabs(s.x), std::fabs(s.y), std::fabs(s.z)}) < wall;
  });
  return cage;
}

TEST(AMillionSteps, KeepMomentumAndEnergy) {
  constexpr double kDt = 1.0 / 2000, kSpeed = 1;          // [s], [m/s]
  constexpr double kCage = 300, kBall = 30, kRoom = 0.3;  // [kg], [m]
  ContactOptions options;
  options.response = Response::penalty;
  options.stiffness = 1e7;
  options.damping = 0;
  WatchedWorld world(options);
  world.world.setGravity(btVector3(0, 0, 0));
  btRigidBody& cage = world.add(makeShape(cageOf(6)), kCage, btVector3(0, 0, 0));
  btRigidBody& ball =
      world.add(makeShape(withoutSurface(singleBall(0.2))), kBall, btVector3(btScalar(0.03), 0, 0));
  for (btRigidBody* body : {&cage, &ball}) body->setFriction(0);
  ball.setLinearVelocity(btVector3(btScalar(kSpeed), btScalar(0.37), btScalar(0.21)));
  cage.setLinearVelocity(ball.getLinearVelocity() * btScalar(-kBall / kCage));
  const auto momentum = [&] {
    return cage.getLinearVelocity() * btScalar(kCage) + ball.getLinearVelocity() * btScalar(kBall);
  };
  const auto angular = [&] {
    btVector3 sum(0, 0, 0);
    for (const btRigidBody* body : {&cage, &ball}) {
      sum += body->getCenterOfMassPosition().cross(body->getLinearVelocity()) / body->getInvMass() +
             body->getInvInertiaTensorWorld().inverse() * body->getAngularVelocity();
    }
    return sum;
  };
  const double energy = world.kineticEnergy();
  const btVector3 start = momentum(), start_angular = angular();
  double worst = 0, worst_momentum = 0, worst_angular = 0;
  int free = 0, touching = 0;
  for (int block = 0; block < 10000; ++block) {
    for (int i = 0; i < 100; ++i) world.world.stepSimulation(btScalar(kDt), 0);
    const bool apart = pairOverlaps(&world.dispatcher).empty();
    ++(apart ? free : touching);
    if (apart) worst = std::max(worst, std::fabs(world.kineticEnergy() / energy - 1));
    worst_momentum = std::max(worst_momentum, double((momentum() - start).length()) / (kBall * kSpeed));
    worst_angular =
        std::max(worst_angular, double((angular() - start_angular).length()) / (kBall * kSpeed * kRoom));
  }
  EXPECT_GT(free, 1000);
  EXPECT_GT(touching, 100);
  EXPECT_LT(cage.getCenterOfMassPosition().distance(ball.getCenterOfMassPosition()), 0.5) << "still inside";
  const bool exact = sizeof(btScalar) == 8;
  EXPECT_LT(worst, exact ? 1e-4 : 1e-3);
  EXPECT_LT(worst_momentum, exact ? 1e-12 : 1e-4);
  EXPECT_LT(worst_angular, exact ? 1e-10 : 1e-3);
}

}  // namespace
}  // namespace innersphere::test
