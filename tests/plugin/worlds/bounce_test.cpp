// Balls that are packed bounce off each other as spheres do, whatever is foretold beside where they meet.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <tuple>
#include <utility>

#include "innersphere/substep_solver.hpp"
#include "named_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kRadius = 0.1, kSpeed = 3;
constexpr int kTries = 8;

class Bounce : public testing::TestWithParam<std::tuple<Response, double>> {
 protected:
  static void SetUpTestSuite() { ball = makeMeshBallShape(kRadius, 256); }
  static void TearDownTestSuite() { ball.reset(); }
  static std::shared_ptr<PackingShape> ball;
};
std::shared_ptr<PackingShape> Bounce::ball;

// Without friction nothing turns a sphere. Points beside the first one, which meet later in the step, have
// other normals: if the balls bounced from these, too, they would gain from each. In a step the line between
// two balls turns by an angle of way / 2 r at most, so that what is left of the first one's speed is known
// but for its square.
TEST_P(Bounce, TurnsNoBall) {
  const auto [response, steps] = GetParam();
  for (int i = 0; i < kTries; ++i) {
    ContactOptions options;
    options.response = response;
    TestWorld world(options);
    world.world.setGravity(btVector3(0, 0, 0));
    const double aside = kRadius * i / kTries, away = 2.2 * kRadius + i * kSpeed / steps / kTries;
    const btQuaternion turned(btVector3(1, 2, btScalar(i)).normalized(), btScalar(i));
    btRigidBody& a = world.add(ball, 1, btVector3(btScalar(-away), btScalar(aside), 0), turned);
    btRigidBody& b = world.add(ball, 1, btVector3(0, 0, 0), turned.inverse());
    for (btRigidBody* body : {&a, &b}) {
      body->setRestitution(1);
      body->setFriction(0);
    }
    a.setLinearVelocity(btVector3(kSpeed, 0, 0));
    world.run(0.3, 1 / steps);
    SCOPED_TRACE(testing::Message() << "aside " << aside);
    const double sine = aside / (2 * kRadius), angle = kSpeed / steps / (2 * kRadius);
    EXPECT_NEAR(double(a.getLinearVelocity().x()), kSpeed * sine * sine,
                kSpeed * (2 * sine * angle + angle * angle));
    EXPECT_NEAR(world.kineticEnergy(), kSpeed * kSpeed / 2, 1e-3 * kSpeed * kSpeed);
    for (const btRigidBody* body : {&a, &b})
      EXPECT_LT(double(body->getAngularVelocity().length()), 0.01 * kSpeed / kRadius);
  }
}

// A ball that does not turn and hits a floor slides until friction has it roll: by its angular momentum about
// the place, it leaves with 5/7 of its speed along the floor. The place is on its own surface, however far
// the floor is when the step begins: further out, the same push turned it by up to 1.4 times as much.
TEST_P(Bounce, RollsOffAFloor) {
  const auto [response, steps] = GetParam();
  constexpr double kDown = 4, kAlong = 1, kRestitution = 0.5;
  for (const bool plane : {true, false}) {
    for (int i = 1; i <= kTries; ++i) {
      ContactOptions options;
      options.response = response;
      TestWorld world(options);
      world.world.setGravity(btVector3(0, 0, 0));
      if (plane)
        world.addFloor();
      else
        world.add(std::make_shared<btBoxShape>(btVector3(2, 2, 1)), 0, btVector3(0, 0, -1));
      world.bodies.back()->setRestitution(1);
      world.bodies.back()->setFriction(1);
      const double gap = (i - 0.5) / kTries * kDown / steps;
      btRigidBody& body = world.add(ball, 1, btVector3(0, 0, btScalar(kRadius + gap)),
                                    btQuaternion(btVector3(1, 2, btScalar(i)).normalized(), btScalar(i)));
      body.setRestitution(kRestitution);
      body.setFriction(1);
      body.setLinearVelocity(btVector3(kAlong, 0, -kDown));
      world.run(4 / steps, 1 / steps);
      SCOPED_TRACE(testing::Message() << "gap " << gap << (plane ? ", plane" : ", box"));
      EXPECT_NEAR(double(body.getLinearVelocity().z()), kRestitution * kDown, 0.005 * kDown);
      EXPECT_NEAR(double(body.getLinearVelocity().x()), kAlong * 5 / 7, 0.005 * kAlong);
      EXPECT_NEAR(double(body.getAngularVelocity().y()), kAlong * 5 / 7 / kRadius, 0.005 * kAlong / kRadius);
    }
  }
}

// With substeps each was higher than it should be by the way of one, so that a ball that loses nothing rose
// by 5 mm in each second. Bullet's solver had balls that lose some turn round up to the way of a step above
// the floor, as fast as at the floor: by a quarter too high at 60 steps/s.
TEST_P(Bounce, IsAsHighAsRestitutionSays) {
  const auto [response, steps] = GetParam();
  constexpr double kGravity = 9.81;
  for (const bool substeps : {false, true}) {
    for (const auto& [e, height] :
         {std::pair(0.8, 0.5), {0.8, 2.0}, {0.95, 0.5}, {0.95, 2.0}, {1.0, 0.5}, {1.0, 2.0}}) {
      ContactOptions options;
      options.response = response;
      TestWorld world(options);
      SubstepSolver solver;
      if (substeps) world.world.setConstraintSolver(&solver);
      PackingCollisionAlgorithm::prepareWorld(world.world, options);
      world.world.setGravity(btVector3(0, 0, btScalar(-kGravity)));
      world.addFloor().setRestitution(1);
      btRigidBody& body = world.add(ball, 1, btVector3(0, 0, btScalar(height + kRadius)));
      body.setRestitution(btScalar(e));
      body.setActivationState(DISABLE_DEACTIVATION);
      const int bounces = e < 1 ? 5 : 10;
      const double step = 1 / steps, apex = height * std::pow(e, 2 * bounces);
      btScalar speed = 0;
      for (int tops = 0; tops < bounces + 1;) {
        world.run(step, step);
        const btScalar before = std::exchange(speed, body.getLinearVelocity().z());
        if (before >= 0 && speed < 0) ++tops;
        ASSERT_TRUE(std::isfinite(speed));
      }
      const double highest = body.getWorldTransform().getOrigin().z() - kRadius;
      EXPECT_NEAR(highest, apex, (substeps ? 0.002 : 0.01) * height + kGravity * step * step)
          << e << ", from " << height << (substeps ? ", substeps" : "");
      world.world.setConstraintSolver(&world.solver);
    }
  }
}

std::string nameOfCase(const testing::TestParamInfo<std::tuple<Response, double>>& info) {
  return nameOf(std::get<Response>(info.param)) + std::to_string(int(std::get<double>(info.param)));
}

INSTANTIATE_TEST_SUITE_P(Balls, Bounce,
                         testing::Combine(testing::Values(Response::compliant, Response::rigid),
                                          testing::Values(60.0, 240.0)),
                         nameOfCase);

}  // namespace
}  // namespace innersphere::test
