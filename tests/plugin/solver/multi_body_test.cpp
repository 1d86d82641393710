// Rigid bodies and btMultiBody in one world, under MultiBodySubstepSolver, beside worlds with one solver for
// each.
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "capture_log.hpp"
#include "innersphere/multi_body_substep_solver.hpp"
#include "solver/solver_world.hpp"

namespace innersphere::test {
namespace {

constexpr btScalar kHalf = btScalar(0.25);  // of a box's edge [m]
constexpr btScalar kStep = btScalar(1) / 60;

/// A world for btMultiBody over the parts of a SolverWorld.
class MixedWorld {
 public:
  explicit MixedWorld(btMultiBodyConstraintSolver& solver)
      : world(&parts.dispatcher, &parts.broadphase, &solver, &parts.configuration) {
    world.setGravity(btVector3(0, 0, -kGravity));
    world.getSolverInfo().m_minimumSolverBatchSize = -1;
  }
  ~MixedWorld() {
    for (const auto& body : bodies) world.removeRigidBody(body.get());
    if (ball) world.removeMultiBody(ball.get());
    if (collider) world.removeCollisionObject(collider.get());
  }

  void addBox(const btVector3& half, btScalar mass, const btVector3& position) {
    shapes.push_back(std::make_unique<btBoxShape>(half));
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shapes.back()->calculateLocalInertia(mass, inertia);
    bodies.push_back(std::make_unique<btRigidBody>(mass, nullptr, shapes.back().get(), inertia));
    bodies.back()->setWorldTransform(btTransform(btQuaternion::getIdentity(), position));
    bodies.back()->setActivationState(DISABLE_DEACTIVATION);
    world.addRigidBody(bodies.back().get());
  }
  void addStack(int count, btScalar x) {
    for (int i = 0; i < count; ++i)
      addBox(btVector3(kHalf, kHalf, kHalf), 1, btVector3(x, 0, (2 * i + 1) * kHalf));
  }
  void addFloor() { addBox(btVector3(50, 50, 1), 0, btVector3(0, 0, -1)); }
  /// A ball in reduced coordinates.
  void addBall(const btVector3& position) {
    shapes.push_back(std::make_unique<btSphereShape>(kHalf));
    btVector3 inertia;
    shapes.back()->calculateLocalInertia(1, inertia);
    ball = std::make_unique<btMultiBody>(0, 1, inertia, false, false);
    ball->setBaseWorldTransform(btTransform(btQuaternion::getIdentity(), position));
    ball->finalizeMultiDof();
    collider = std::make_unique<btMultiBodyLinkCollider>(ball.get(), -1);
    collider->setCollisionShape(shapes.back().get());
    collider->setWorldTransform(ball->getBaseWorldTransform());
    ball->setBaseCollider(collider.get());
    world.addCollisionObject(collider.get());
    world.addMultiBody(ball.get());
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) world.stepSimulation(kStep, 0);
  }
  std::vector<btScalar> placesOfBoxes() const {
    std::vector<btScalar> all;
    for (const auto& body : bodies) {
      const btVector3& at = body->getWorldTransform().getOrigin();
      all.insert(all.end(), {at.x(), at.y(), at.z()});
    }
    return all;
  }

  SolverWorld parts;
  btMultiBodyDynamicsWorld world;
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  std::unique_ptr<btMultiBody> ball;
  std::unique_ptr<btMultiBodyLinkCollider> collider;
};

TEST(MultiBodySubstep, RigidBodiesMoveAsWithSubstepSolver) {
  MultiBodySubstepSolver solver;
  MixedWorld mixed(solver);
  mixed.addFloor();
  mixed.addStack(10, 0);
  SolverWorld alone;
  alone.addSlab();
  for (int i = 0; i < 10; ++i)
    alone.addBox(btVector3(kHalf, kHalf, kHalf), 1, btVector3(0, 0, (2 * i + 1) * kHalf));
  mixed.run(120);
  alone.run(2);
  EXPECT_EQ(solver.substepSolver().substeps(), alone.solver.substeps());
  for (int i = 0; i <= 10; ++i)
    EXPECT_EQ(mixed.bodies[i]->getWorldTransform().getOrigin(),
              alone.bodies[i]->getWorldTransform().getOrigin());
}

TEST(MultiBodySubstep, BulletsSolverHasTheGroupOfAMultiBodyWholeAndNoOther) {
  btMultiBodyConstraintSolver bullets, others;
  MultiBodySubstepSolver itself, with_others({}, &others);
  const btVector3 on_box(btScalar(0.05), 0, 3 * kHalf);
  MixedWorld stack(itself), with_ball(bullets);
  stack.addFloor();
  stack.addStack(3, 20);
  stack.run(60);
  with_ball.addFloor();
  with_ball.addStack(1, 0);
  with_ball.addBall(on_box);
  with_ball.run(60);
  for (MultiBodySubstepSolver* solver : {&itself, &with_others}) {
    MixedWorld both(*solver);
    both.addFloor();
    both.addStack(1, 0);
    both.addBall(on_box);
    both.addStack(3, 20);
    both.run(60);
    EXPECT_GT(solver->substepSolver().substeps(), 1);
    EXPECT_EQ(both.ball->getBasePos(), with_ball.ball->getBasePos());
    const std::vector<btScalar> expected = with_ball.placesOfBoxes();
    const std::vector<btScalar> places = both.placesOfBoxes(), alone = stack.placesOfBoxes();
    EXPECT_EQ(std::vector(places.begin(), places.begin() + 6), expected);
    EXPECT_EQ(std::vector(places.begin() + 6, places.end()), std::vector(alone.begin() + 3, alone.end()));
  }
}

TEST(MultiBodySubstep, TheLogSaysOnceThatBulletPutsAllIntoOneGroup) {
  for (const int batch : {128, -1}) {
    MultiBodySubstepSolver solver;
    MixedWorld mixed(solver);
    mixed.world.getSolverInfo().m_minimumSolverBatchSize = batch;
    mixed.addFloor();
    mixed.addStack(1, 0);
    mixed.addBall(btVector3(20, 0, kHalf));
    const CaptureLog log;
    mixed.run(10);
    ASSERT_EQ(log.messages.size(), batch > 0 ? 1u : 0u);
    if (batch > 0) EXPECT_NE(log.messages[0].find("m_minimumSolverBatchSize = -1"), std::string::npos);
  }
}

}  // namespace
}  // namespace innersphere::test
