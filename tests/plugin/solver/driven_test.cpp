// What lies on bodies that move by themselves, under SubstepSolver.
#include <algorithm>
#include <memory>

#include <gtest/gtest.h>

#include "innersphere/packing_collision_algorithm.hpp"
#include "innersphere/substep_solver.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kHalf = 0.1;  // of the load's edge [m]
constexpr double kGravity = 9.81;

/// A plate of 2 m, moved to a place in each step, with a box on it that friction holds up to 4.9 m/s^2.
class Plate {
 public:
  explicit Plate(double rate, double x = 0, bool packed = true) : dt_(1 / rate) {
    PackingCollisionAlgorithm::prepareWorld(world_.world);
    world_.world.setConstraintSolver(&solver_);
    plate_ = &world_.add(std::make_shared<btBoxShape>(btVector3(1, 1, btScalar(kHalf))), 0,
                         btVector3(0, 0, btScalar(-kHalf)));
    plate_->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    plate_->setActivationState(DISABLE_DEACTIVATION);
    plate_->setFriction(1);
    std::shared_ptr<btCollisionShape> shape = std::make_shared<btBoxShape>(btVector3(kHalf, kHalf, kHalf));
    if (packed) shape = makeShape(latticeBox({2 * kHalf, 2 * kHalf, 2 * kHalf}, 4));
    load_ = &world_.add(shape, 1, btVector3(btScalar(x), 0, btScalar(kHalf)));
    load_->setFriction(btScalar(0.5));
    load_->setActivationState(DISABLE_DEACTIVATION);
    world_.run(0.5, dt_);
    on_plate_ = onPlate();
  }

  void moveTo(double x, double angle) {
    const btQuaternion turn(btVector3(0, 0, 1), btScalar(angle));
    plate_->setWorldTransform(btTransform(turn, btVector3(btScalar(x), 0, btScalar(-kHalf))));
    world_.run(dt_, dt_);
  }
  /// Where the load has gone on the plate since it came to rest [m].
  btVector3 slip() const { return onPlate() - on_plate_; }
  btVector3 onPlate() const {
    return plate_->getWorldTransform().inverse() * load_->getWorldTransform().getOrigin();
  }
  btRigidBody& load() { return *load_; }

 private:
  double dt_;
  SubstepSolver solver_;
  TestWorld world_;
  btRigidBody *plate_, *load_;
  btVector3 on_plate_;
};

// Friction that began anew in each substep lagged by v a dt / (2 mu g), 15 mm at 60 steps/s.
TEST(SubstepDriven, WhatSpeedsUpTakesItsLoadAlong) {
  for (const int rate : {60, 240}) {
    Plate plate(rate);
    for (int i = 1; i <= rate; ++i) plate.moveTo(1.5 * i * i / rate / rate, 0);  // 3 m/s^2
    EXPECT_LT(plate.slip().length(), 0.001) << rate;
  }
}

// Past the limit it falls behind, as physics has it.
TEST(SubstepDriven, WhatSpeedsUpTooFastLeavesItsLoadBehind) {
  const int rate = 240;
  Plate plate(rate);
  for (int i = 1; i <= rate / 2; ++i) plate.moveTo(4.0 * i * i / rate / rate, 0);  // 8 m/s^2, for 0.5 s
  EXPECT_NEAR(plate.slip().x(), -(8 - 0.5 * kGravity) / 8, 0.01);
}

// A jump is one, and does not throw the load further.
TEST(SubstepDriven, WhatStartsAtOnceDoesNotOvershoot) {
  const int rate = 60;
  Plate plate(rate);
  for (int i = 1; i <= 3; ++i) {
    plate.moveTo(0.05 * i / rate, 0);  // 0.05 m/s, of which friction brings 0.08 in a step
    EXPECT_LT(plate.load().getLinearVelocity().x(), 0.051) << i;
  }
  EXPECT_NEAR(plate.load().getLinearVelocity().x(), 0.05, 0.001);
}

// The load went straight on in each step, (w dt)^2 r / 2 outwards of its place; that of Bullet's boxes
// thrice.
TEST(SubstepDriven, ATurntableKeepsItsLoad) {
  for (const bool packed : {true, false}) {
    for (const int rate : {60, 240}) {
      Plate plate(rate, 0.5, packed);
      double angle = 0;
      for (int i = 1; i <= 3 * rate; ++i) {
        angle += std::min(1.0, 2.0 * i / rate) / rate;  // to 1 rad/s in half a second
        plate.moveTo(0, angle);
      }
      EXPECT_LT(plate.slip().length(), 0.0015) << packed << rate;
    }
  }
}

// In single precision Bullet knows no turn below 7e-4 rad in a step: here it is 4e-4.
TEST(SubstepDriven, ASlowTurntableTakesItsLoadAlong) {
  const int rate = 240;
  Plate plate(rate, 0.5);
  for (int i = 1; i <= 3 * rate; ++i) plate.moveTo(0, 0.1 * i / rate);
  EXPECT_LT(plate.slip().length(), 0.001);  // of a way of 0.15 m
}

}  // namespace
}  // namespace innersphere::test
