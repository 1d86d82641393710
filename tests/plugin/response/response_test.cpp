// Responses keep what Bullet's users know: damping, friction, restitution, rolling and spinning friction.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kGravity = 9.81, kRadius = 0.5;

// A cube of 8 x 8 balls a face that is pushed a little below its rest oscillates as the spring K A does, A
// the area of the cut: its swings shrink as exp(-pi z / sqrt(1 - z^2)), z the fraction of critical damping.
// Backward Euler adds w dt / 2 to it; over a swing the area changes by a twentieth.
class Damping : public testing::Test {
 protected:
  static constexpr int kCells = 8;
  static constexpr double kBall = 0.5 / kCells, kDepth = 0.02, kStep = 1.0 / 4800;

  /// Heights at which the cube turns round [m].
  std::vector<double> turns(double damping, double seconds) {
    const double volume = kCells * kCells * M_PI * kDepth * kDepth * (3 * kBall - kDepth) / 3;
    const double area = kCells * kCells * M_PI * kDepth * (2 * kBall - kDepth);
    ContactOptions options;
    options.stiffness = kGravity / volume;  // for 1 kg
    options.damping = damping;
    options.estimator = Estimator::raw;
    rate = std::sqrt(options.stiffness * area);
    TestWorld world(options);
    world.addFloor();
    const double start = 0.5 - 1.05 * kDepth;
    btRigidBody& cube =
        world.add(makeShape(latticeBox({1, 1, 1}, kCells)), 1, btVector3(0, 0, btScalar(start)));
    cube.setActivationState(DISABLE_DEACTIVATION);
    std::vector<double> heights{start};
    double before = 1;
    for (double t = 0; t < seconds; t += kStep) {
      world.run(kStep, kStep);
      const double speed = cube.getLinearVelocity().z();
      if (speed * before < 0) heights.push_back(cube.getWorldTransform().getOrigin().z());
      before = speed;
    }
    return heights;
  }
  double rate = 0;  ///< [rad/s]
};

TEST_F(Damping, SwingsShrinkByTheFractionOfCriticalDamping) {
  for (const double damping : {0.0, 0.05, 0.2}) {
    const std::vector<double> heights = turns(damping, 0.6);
    ASSERT_GT(heights.size(), 4u);
    const double first = heights[1] - heights[0], third = heights[3] - heights[2];
    const double fraction = damping + rate * kStep / 2;
    const double expected = 2 * M_PI * fraction / std::sqrt(1 - fraction * fraction);
    EXPECT_NEAR(std::log(first / third), expected, 0.05 * expected + 0.005) << damping;
  }
}

TEST_F(Damping, AtOneThereIsNoRebound) {
  const std::vector<double> heights = turns(1, 0.6);
  EXPECT_LT(*std::max_element(heights.begin(), heights.end()), 0.5 - kDepth + 0.02 * 0.05 * kDepth);
}

struct Law {
  const char* name;
  Response response;
  double stiffness;

  friend void PrintTo(const Law& law, std::ostream* out) { *out << law.name; }
};

class Responses : public testing::TestWithParam<Law> {
 protected:
  Responses() : world(options()) {
    floor = &world.addFloor();
    floor->setFriction(1);
    floor->setRestitution(1);
  }
  static ContactOptions options() {
    ContactOptions options;
    options.response = GetParam().response;
    options.stiffness = GetParam().stiffness;
    return options;
  }
  btRigidBody& add(std::shared_ptr<PackingShape> shape, double height) {
    btRigidBody& body = world.add(std::move(shape), 1, btVector3(0, 0, btScalar(height)));
    body.setActivationState(DISABLE_DEACTIVATION);
    return body;
  }
  /// Lies on the floor, at rest.
  btRigidBody& addBall() {
    world.world.getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
    btRigidBody& ball = add(makeShape(singleBall(kRadius)), kRadius);
    world.run(0.5, kStep);
    return ball;
  }

  static constexpr double kStep = 1.0 / 480;
  TestWorld world;
  btRigidBody* floor = nullptr;
};

TEST_P(Responses, FrictionHoldsOnASlopeAndSlidesAboveItsAngle) {
  constexpr double kFriction = 0.5;
  btRigidBody& cube = add(makeShape(latticeBox({1, 1, 0.5}, 8)), 0.25);
  cube.setFriction(btScalar(kFriction));
  for (const int directions : {0, int(SOLVER_USE_2_FRICTION_DIRECTIONS)}) {
    world.world.getSolverInfo().m_solverMode |= directions;
    for (const double slope : {0.45, 0.55}) {  // tangents
      cube.setLinearVelocity(btVector3(0, 0, 0));
      const double angle = std::atan(slope);
      cube.setGravity(
          btVector3(btScalar(kGravity * std::sin(angle)), 0, btScalar(-kGravity * std::cos(angle))));
      world.run(0.5, kStep);
      const double before = cube.getLinearVelocity().x();
      world.run(1, kStep);
      const double expected = std::max(0.0, kGravity * (std::sin(angle) - kFriction * std::cos(angle)));
      EXPECT_NEAR(cube.getLinearVelocity().x() - before, expected, 0.02 * expected + 1e-3) << slope;
      if (expected == 0) {
        EXPECT_NEAR(before, 0, 1e-3);
      }
    }
  }
}

TEST_P(Responses, RestitutionIsTheShareOfTheSpeedThatReturns) {
  for (const double e : {0.3, 0.7}) {
    btRigidBody& ball = add(makeShape(singleBall(kRadius)), 1.1 * kRadius);
    ball.setGravity(btVector3(0, 0, 0));
    ball.setRestitution(btScalar(e));
    ball.setLinearVelocity(btVector3(0, 0, -2));
    world.run(0.5, kStep);
    EXPECT_NEAR(ball.getLinearVelocity().z(), 2 * e, 0.02 * 2);
    ball.setCollisionFlags(btCollisionObject::CF_NO_CONTACT_RESPONSE);  // out of the next one's way
  }
}

// A load that lies a lever ahead of the middle slows the ball by g lever / R / (1 + 2/5).
TEST_P(Responses, RollingFrictionIsALeverOfTheLoad) {
  constexpr double kLever = 0.02;
  btRigidBody& ball = addBall();
  ball.setFriction(1);
  ball.setRollingFriction(btScalar(kLever));
  ball.setLinearVelocity(btVector3(1, 0, 0));
  ball.setAngularVelocity(btVector3(0, btScalar(1 / kRadius), 0));
  world.run(1, kStep);
  const double slowing = kGravity * kLever / kRadius / 1.4;
  EXPECT_NEAR(1 - ball.getLinearVelocity().x(), slowing, 0.05 * slowing);
}

class AllResponses : public Responses {};

// Its torque about the normal is the load times it, whatever friction the places of the contact have. Bullet
// reads it only of bodies with rolling friction.
TEST_P(AllResponses, SpinningFrictionIsALeverOfTheLoad) {
  constexpr double kLever = 0.02;
  btRigidBody& ball = addBall();
  ball.setFriction(0);
  ball.setRollingFriction(btScalar(kLever));
  ball.setSpinningFriction(btScalar(kLever));
  ball.setAngularVelocity(btVector3(0, 0, 5));
  world.run(1, kStep);
  const double slowing = kGravity * kLever / (0.4 * kRadius * kRadius);
  EXPECT_NEAR(5 - ball.getAngularVelocity().z(), slowing, 0.05 * slowing);
}

const Law kLaws[] = {{"compliant", Response::compliant, 0},
                     {"stiffness", Response::compliant, 1e5},
                     {"rigid", Response::rigid, 0},
                     {"penalty", Response::penalty, 1e5}};
std::string nameOf(const testing::TestParamInfo<Law>& info) {
  return info.param.name;
}

// Friction and restitution of penalty forces are their own: see Penalty.
INSTANTIATE_TEST_SUITE_P(Of, Responses, testing::ValuesIn(kLaws, kLaws + 3), nameOf);
INSTANTIATE_TEST_SUITE_P(Of, AllResponses, testing::ValuesIn(kLaws), nameOf);

}  // namespace
}  // namespace innersphere::test
