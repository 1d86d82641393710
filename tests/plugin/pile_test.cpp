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

}  // namespace
}  // namespace innersphere::test
