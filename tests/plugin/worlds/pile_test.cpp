#include <gtest/gtest.h>

#include <random>

#include "named_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kHalfWidth = 0.9;

void addTray(TestWorld& world) {
  world.add(std::make_shared<btBoxShape>(btVector3(2, 2, 1)), 0, btVector3(0, 0, -1));
  for (const int side : {-1, 1}) {
    const btScalar at = btScalar(side * (kHalfWidth + 0.1));
    world.add(std::make_shared<btBoxShape>(btVector3(btScalar(0.1), 2, 1)), 0, btVector3(at, 0, 1));
    world.add(std::make_shared<btBoxShape>(btVector3(2, btScalar(0.1), 1)), 0, btVector3(0, at, 1));
  }
}

TEST(Pile, OfToriAndBracketsInATrayComesToRest) {
  TestWorld world;
  addTray(world);
  const std::shared_ptr<PackingShape> shapes[] = {makeNamedShape("torus", 500, 0.35),
                                                  makeNamedShape("lbracket", 500, 0.35)};
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const std::size_t first = world.bodies.size();
  for (int i = 0; i < 10; ++i) {
    btQuaternion turn(btScalar(uniform(rng)), btScalar(uniform(rng)), btScalar(uniform(rng)),
                      btScalar(uniform(rng)));
    world.add(
        shapes[i % 2], 1,
        btVector3(btScalar(0.4 * (i % 3 - 1)), btScalar(0.4 * (i / 3 % 3 - 1)), btScalar(0.5 + 0.3 * i)),
        turn.normalized());
  }
  world.run(5);
  EXPECT_LT(world.kineticEnergy(), 0.1);  // 10 kg that fell 2 m on average had 200 J
  for (std::size_t i = first; i < world.bodies.size(); ++i) {
    const btVector3 at = world.bodies[i]->getWorldTransform().getOrigin();
    EXPECT_GT(at.z(), 0);
    EXPECT_LT(at.z(), 1);
    EXPECT_LT(btFabs(at.x()), kHalfWidth);
    EXPECT_LT(btFabs(at.y()), kHalfWidth);
  }
  EXPECT_LT(world.deepestContact(), 0.02);
}

// Bullet's friction knows speeds only, and what its iterations leave of them lets bodies creep by a tenth of
// a millimetre a second, each of them; a body that rocks on two points shakes all others. What may move is a
// torus that rolls. Which pile becomes of a start is chance: of 40 alike one or two lie less still than this.
TEST(Pile, LiesStillWhereBodiesMayNotSleep) {
  const std::shared_ptr<PackingShape> shapes[] = {makeNamedShape("torus", 500, 0.35),
                                                  makeNamedShape("lbracket", 500, 0.35)};
  std::vector<double> moved;
  for (const double more : {0.0, 0.01, 0.02}) {
    TestWorld world;
    world.world.getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
    addTray(world);
    const std::size_t first = world.bodies.size();
    for (int i = 0; i < 12; ++i) {
      const btQuaternion turn(btVector3(btScalar(i % 5 - 2), btScalar(i % 3 - 1), 1).normalized(),
                              btScalar(i + more));
      const btVector3 place(btScalar(0.3 * (i % 3 - 1)), btScalar(0.3 * (i / 3 % 3 - 1)),
                            btScalar(0.5 + 0.3 * i));
      world.add(shapes[i % 2], 1, place, turn).setActivationState(DISABLE_DEACTIVATION);
    }
    world.run(10, 1.0 / 240);
    std::vector<btVector3> before;
    for (const auto& body : world.bodies) before.push_back(body->getWorldTransform().getOrigin());
    world.run(1, 1.0 / 240);
    for (std::size_t i = first; i < world.bodies.size(); ++i)
      moved.push_back(double(world.bodies[i]->getWorldTransform().getOrigin().distance(before[i])));
  }
  std::sort(moved.begin(), moved.end());
  EXPECT_LT(moved[moved.size() / 2], 1e-5);
}

}  // namespace
}  // namespace innersphere::test
