// How hard contacts push in a chain.
#include <gtest/gtest.h>

#include "named_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

// Balls of a row touch two others at most, each in one round place. The ball in the middle of a heap does
// not.
TEST(ChainLaw, IsStifferAndLessSteepThanOfAHeap) {
  constexpr double kStep = 1.0 / 60, kRadius = 0.5, kMass = 1;
  for (const bool heap : {false, true}) {
    TestWorld world;
    world.world.setGravity(btVector3(0, 0, 0));
    const auto ball = makeFineBallShape(kRadius, 200);
    const auto apart = btScalar(2 * kRadius - 0.0005);
    const btRigidBody& below = world.add(ball, 0, btVector3(0, 0, 0));
    const btRigidBody& middle = world.add(ball, kMass, btVector3(0, 0, apart));
    world.add(ball, kMass, btVector3(0, 0, 2 * apart));
    if (heap) world.add(ball, kMass, btVector3(apart, 0, apart));
    for (int i = 0; i < 2; ++i) world.run(kStep, kStep);  // the first one tells how many touch
    int found = 0;
    for (int m = 0; m < world.dispatcher.getNumManifolds(); ++m) {
      const btPersistentManifold& manifold = *world.dispatcher.getManifoldByIndexInternal(m);
      if (manifold.getNumContacts() == 0) continue;
      if (manifold.getBody0() != &below && manifold.getBody1() != &below) continue;
      ASSERT_TRUE(manifold.getBody0() == &middle || manifold.getBody1() == &middle);
      ASSERT_EQ(manifold.getNumContacts(), 1);
      const btManifoldPoint& point = manifold.getContactPoint(0);
      const double depth = -double(point.getDistance()) / kRadius;
      ASSERT_GT(depth, 1e-4);
      const double expected = heap ? 18 * (1 + depth / 0.002) : 31 * (1 + depth / 0.005);
      EXPECT_NEAR(double(point.m_combinedContactStiffness1) * kStep * kStep / kMass, expected,
                  0.01 * expected);
      ++found;
    }
    EXPECT_EQ(found, 1);
  }
}

}  // namespace
}  // namespace innersphere::test
