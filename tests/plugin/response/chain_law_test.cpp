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

// Of a load W that stands on a lever s, W s for a radian pushes the ball further over. Backward Euler takes
// it at the end of the step: at W a further way s w dt ahead.
TEST(ChainLaw, ResistsTiltingUnderTheWeightOfSeveralLinks) {
  constexpr double kStep = 1.0 / 60, kRadius = 0.5, kTilts = 0.7, kAhead = 1e-5;
  struct Case {
    double depth;  // in radii; twice as much as makes the spring half as stiff again, and a tenth of it
    btVector3 spin;
    double lever;
  };
  const btVector3 tilts(btScalar(kTilts), 0, 0), spins(0, 0, btScalar(kTilts));
  for (const Case& c : {Case{0.005, tilts, kAhead + kTilts * kStep}, Case{0.005, spins, kAhead},
                        Case{0.00025, tilts, kAhead}}) {
    TestWorld world;
    world.world.setGravity(btVector3(0, 0, 0));
    const auto ball = makeFineBallShape(kRadius, 200);
    const auto apart = btScalar(kRadius * (2 - c.depth));
    const btRigidBody& below = world.add(ball, 0, btVector3(0, 0, 0));
    btRigidBody& middle = world.add(ball, 1, btVector3(0, 0, apart));
    world.add(ball, 0, btVector3(0, 0, apart + btScalar(2 * kRadius - 0.0005)));
    for (int i = 0; i < 2; ++i) {             // the first one tells how many touch
      const auto moved = btScalar(1e-6 * i);  // what lies where it did begins no step
      middle.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, apart + moved)));
      middle.setLinearVelocity(btVector3(0, 0, 0));
      middle.setAngularVelocity(c.spin);
      world.run(kStep, kStep);
    }
    ASSERT_EQ(world.dispatcher.getNumManifolds(), 2);
    const btPersistentManifold* manifold = world.dispatcher.getManifoldByIndexInternal(0);
    if (manifold->getBody0() != &below && manifold->getBody1() != &below)
      manifold = world.dispatcher.getManifoldByIndexInternal(1);
    ASSERT_EQ(manifold->getNumContacts(), 1);
    EXPECT_NEAR(double(manifold->getContactPoint(0).m_combinedRollingFriction), kRadius * c.lever,
                0.01 * kRadius * c.lever);
  }
}

}  // namespace
}  // namespace innersphere::test
