// Worlds whose contacts are used again from step to step move like those that search in every step.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include <BulletCollision/CollisionShapes/btCompoundShape.h>

#include "innersphere/contact_statistics.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr btScalar kHalf = btScalar(0.5);

struct Scene {
  std::string name;
  std::function<void(TestWorld&)> fill;
  double seconds;
  /// How far any body may be from where it is without reuse, for bodies of 1 m [m]. Contacts that are moved
  /// along are a hundredth of a tenth of a spacing off, some 0.1 mm here; what rolls, and a stack that sways,
  /// add that up.
  double tolerance;
  double searched;  ///< at most, as a part of all pairs
};

void addStack(TestWorld& world) {
  world.addFloor();
  const auto cube = makeShape(latticeBox({1, 1, 1}, 6));
  for (int i = 0; i < 3; ++i) world.add(cube, 1, btVector3(btScalar(0.02 * i), 0, btScalar(0.5 + i)));
}

void addOnBox(TestWorld& world) {
  world.add(std::make_shared<btBoxShape>(btVector3(3, 3, kHalf)), 0, btVector3(0, 0, -kHalf));
  world.add(makeShape(latticeBox({1, 1, 1}, 6)), 1, btVector3(0, 0, btScalar(0.6)),
            btQuaternion(btVector3(0, 0, 1), btScalar(0.4)));
}

void addRollingBall(TestWorld& world) {
  world.add(makeShape(latticeBox({6, 3, 1}, 8)), 0, btVector3(0, 0, -kHalf));
  btRigidBody& ball = world.add(makeShape(singleBall(0.5)), 1, btVector3(-1, 0, kHalf));
  ball.setLinearVelocity(btVector3(btScalar(0.2), 0, 0));
  ball.setAngularVelocity(btVector3(0, btScalar(0.4), 0));
}

void addCompound(TestWorld& world) {
  world.add(makeShape(latticeBox({6, 6, 1}, 8)), 0, btVector3(0, 0, -kHalf));
  const auto cube = makeShape(latticeBox({1, 1, 1}, 6));
  const auto pair = std::make_shared<btCompoundShape>();
  for (const int side : {-1, 1})
    pair->addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(btScalar(0.7 * side), 0, 0)),
                        cube.get());
  world.add(cube, 0, btVector3(0, 0, -3));  // keeps the child's shape
  world.add(pair, 2, btVector3(0, 0, btScalar(0.55)));
}

const Scene kScenes[] = {{"Stack", addStack, 2, 1e-3, 0.25},
                         {"OnBox", addOnBox, 2, 5e-4, 0.25},
                         {"RollingBall", addRollingBall, 2, 5e-3, 0.5},
                         {"Compound", addCompound, 2, 5e-4, 0.25}};

class ReuseIn : public testing::TestWithParam<Scene> {};

TEST_P(ReuseIn, AWorldMovesAsWithoutIt) {
  for (const Response response : {Response::compliant, Response::rigid}) {
    const auto run = [&](bool reuse, ContactStatistics& statistics) {
      ContactOptions options;
      options.response = response;
      options.reuse = reuse ? Reuse::idle : Reuse::search;
      TestWorld world(options);
      GetParam().fill(world);
      for (const auto& body : world.bodies) {
        if (!body->isStaticObject()) body->setActivationState(DISABLE_DEACTIVATION);
      }
      std::vector<btVector3> places;
      for (double time = 0; time < GetParam().seconds; time += 0.25) {
        world.run(0.25, 1.0 / 240);
        for (const auto& body : world.bodies) places.push_back(body->getWorldTransform().getOrigin());
      }
      statistics = contactStatistics(&world.dispatcher);
      return places;
    };
    ContactStatistics with, without;
    const std::vector<btVector3> found = run(true, with), expected = run(false, without);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_LT(found[i].distance(expected[i]), GetParam().tolerance) << nameOf(response) << ' ' << i;
    // Without reuse every pair is searched in every step; with it hardly any.
    EXPECT_EQ(without.idle + without.transported + without.refined, 0u);
    const std::size_t all = with.idle + with.transported + with.refined + with.searched;
    EXPECT_NEAR(double(all), double(without.searched), 0.05 * double(without.searched));
    EXPECT_LT(double(with.searched), GetParam().searched * double(without.searched));
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ReuseIn, testing::ValuesIn(kScenes),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace innersphere::test
