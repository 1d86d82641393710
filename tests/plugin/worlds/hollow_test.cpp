// What slides or rolls in a hollow follows it, and keeps its speed.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "innersphere/substep_solver.hpp"
#include "named_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kRing = 1, kTube = 0.17, kSpeed = 5, kStep = 1.0 / 60;
constexpr int kSteps = 60;

struct Way {
  double radius;  ///< of the ball [m]
  bool packed;
  bool rolls;
};

/// A ball of 1 kg in a tube that is bent to a ring, on its outer wall, with either solver.
class Hollow : public testing::TestWithParam<std::tuple<bool, Way>> {
 protected:
  static void SetUpTestSuite() { tube = makeRingTubeShape(kRing, kTube, 1000); }
  static void TearDownTestSuite() { tube.reset(); }
  static std::shared_ptr<PackingShape> tube;
};
std::shared_ptr<PackingShape> Hollow::tube;

// In a step the ball turns its way by an angle. Planes that touch the wall there, and nothing else, take no
// more than its cosine from the speed, and let it go no further out than a straight line does. SubstepSolver
// has four substeps at least.
TEST_P(Hollow, KeepsASpeed) {
  const auto [substeps, way] = GetParam();
  TestWorld world;
  SubstepSolver solver;
  if (substeps) world.world.setConstraintSolver(&solver);
  PackingCollisionAlgorithm::prepareWorld(world.world);
  world.world.setGravity(btVector3(0, 0, 0));
  const double circle = kRing + kTube - way.radius;
  std::shared_ptr<btCollisionShape> shape;
  if (way.packed)
    shape = makeFineBallShape(way.radius, 256);
  else
    shape = std::make_shared<btSphereShape>(btScalar(way.radius));
  btRigidBody& wall = world.add(tube, 0, btVector3(0, 0, 0));
  btRigidBody& ball = world.add(shape, 1, btVector3(btScalar(circle), 0, 0));
  for (btRigidBody* body : {&wall, &ball}) body->setFriction(way.rolls ? btScalar(1) : btScalar(0));
  ball.setLinearVelocity(btVector3(0, btScalar(kSpeed), 0));
  if (way.rolls) ball.setAngularVelocity(btVector3(0, 0, btScalar(-kSpeed / way.radius)));
  const double angle = kSpeed * kStep / circle, parts = substeps ? 4 : 1;
  for (int i = 0; i < kSteps; ++i) {
    world.run(kStep, kStep);
    const btVector3& at = ball.getWorldTransform().getOrigin();
    ASSERT_NEAR(std::hypot(double(at.x()), double(at.y())), circle, circle * angle * angle / 2) << i;
    ASSERT_NEAR(double(at.z()), 0, 0.1 * kTube) << i;
  }
  world.world.setConstraintSolver(&world.solver);
  const double speed = double(ball.getLinearVelocity().length());
  EXPECT_GT(speed, kSpeed * std::pow(std::cos(angle / parts), kSteps * parts));
  EXPECT_LT(speed, 1.005 * kSpeed);
}

std::string nameOfCase(const testing::TestParamInfo<std::tuple<bool, Way>>& info) {
  const auto [substeps, way] = info.param;
  return std::string(substeps ? "Substeps" : "Bullet") + (way.packed ? "Packed" : "Sphere") +
         std::to_string(int(std::lround(1000 * way.radius))) + (way.rolls ? "Rolls" : "Slides");
}

INSTANTIATE_TEST_SUITE_P(Tube, Hollow,
                         testing::Combine(testing::Bool(),
                                          testing::Values(Way{0.12, true, false}, Way{0.05, true, false},
                                                          Way{0.05, false, false}, Way{0.05, true, true})),
                         nameOfCase);

}  // namespace
}  // namespace innersphere::test
