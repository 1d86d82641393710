// Plain worlds are Bullet's own, careful ones are not.
#include <gtest/gtest.h>

#include "innersphere/error.hpp"
#include "scenes/scene.hpp"
#include "scenes/world.hpp"

namespace innersphere::test {
namespace {

demo::ScenePlay playedRest(bool plain) {
  demo::SceneOptions options;
  options.spheres = 64;
  options.seconds = 4;  // Bullet lets bodies sleep after 2
  options.plain = plain;
  return demo::play(demo::sceneNamed("rest"), options);
}

TEST(Plain, LeavesTheSolverAndTheStepToBulletAndLetsBodiesSleep) {
  const demo::ScenePlay play = playedRest(true);
  const btContactSolverInfo defaults;
  EXPECT_EQ(play.world->bullet().getSolverInfo().m_solverMode, defaults.m_solverMode);
  EXPECT_DOUBLE_EQ(play.options.dt, 1.0 / 60);
  ASSERT_EQ(play.recording.steps.size(), 241u);
  EXPECT_FALSE(play.world->bodies()[0].body->isActive());
  // Each call is a step: a body falls by g t^2 / 2 in what it says.
  demo::SceneWorld world({}, {}, demo::Stepping::plain);
  btRigidBody& ball = world.addBox({1, 1, 1}, 1, btTransform::getIdentity(), {});
  for (int i = 0; i < 60; ++i) world.step(1.0 / 60);
  EXPECT_NEAR(ball.getWorldTransform().getOrigin().z(), -9.81 / 2 * (1 + 1.0 / 60), 1e-3);
}

TEST(Plain, IsNotTheDefault) {
  const demo::ScenePlay play = playedRest(false);
  EXPECT_NE(play.world->bullet().getSolverInfo().m_solverMode & SOLVER_USE_2_FRICTION_DIRECTIONS, 0);
  EXPECT_DOUBLE_EQ(play.options.dt, 1.0 / 240);
  EXPECT_TRUE(play.world->bodies()[0].body->isActive());
}

TEST(Plain, HasAStepOfItsOwn) {
  demo::SceneOptions options;
  options.plain = true;
  options.dt = 1.0 / 240;
  EXPECT_THROW(demo::completed(demo::sceneNamed("rest"), options), Error);
  options.dt = 1.0 / 60;
  EXPECT_NO_THROW(demo::completed(demo::sceneNamed("rest"), options));
}

}  // namespace
}  // namespace innersphere::test
