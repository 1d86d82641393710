// What is kept of a contact while its bodies hardly move against each other.
#include <cmath>

#include <gtest/gtest.h>

#include "innersphere/contact_statistics.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kRadius = 0.5;  // [m]

/// A lattice box of 1 m at the origin, static, and one more body.
class Coherence : public testing::Test {
 protected:
  void addUpper(std::shared_ptr<PackingShape> shape) {
    const auto box = makeShape(latticeBox({1, 1, 1}, 6));
    spacing = std::min(box->getContactBreakingThreshold(gContactBreakingThreshold),
                       shape->getContactBreakingThreshold(gContactBreakingThreshold));
    lower = &world.add(box, 0, btVector3(0, 0, 0));
    upper = &world.add(std::move(shape), 1, btVector3(0, 0, 3));
    upper->setActivationState(DISABLE_DEACTIVATION);
  }
  void place(const btVector3& position, const btQuaternion& rotation = btQuaternion::getIdentity()) {
    upper->setWorldTransform(btTransform(rotation, position));
    world.world.performDiscreteCollisionDetection();
  }
  ContactStatistics count() { return contactStatistics(&world.dispatcher); }
  /// Of the lowest point [m], negative for a gap; the deepest of all contact points.
  double depth() {
    double deepest = -1;
    for (int m = 0; m < world.dispatcher.getNumManifolds(); ++m) {
      const btPersistentManifold& manifold = *world.dispatcher.getManifoldByIndexInternal(m);
      for (int i = 0; i < manifold.getNumContacts(); ++i)
        deepest = std::max(deepest, -double(manifold.getContactPoint(i).getDistance()));
    }
    return deepest;
  }

  TestWorld world;
  btRigidBody* lower = nullptr;
  btRigidBody* upper = nullptr;
  double spacing = 0;
};

TEST_F(Coherence, ABallThatHardlyMovesIsNeitherSearchedNorMeasured) {
  addUpper(makeShape(singleBall(kRadius)));
  const double start = 0.5 + kRadius - 0.003;
  place(btVector3(0, 0, btScalar(start)));
  const ContactStatistics before = count();
  for (int i = 1; i <= 8; ++i) {
    const double move = 0.01 * i * spacing;
    place(btVector3(btScalar(move), 0, btScalar(start + move / 2)));
    EXPECT_NEAR(depth(), 0.003 - move / 2, 1e-5);
  }
  EXPECT_EQ(count().searched, before.searched);
  EXPECT_EQ(count().refined, before.refined);
}

TEST_F(Coherence, ABallThatMovesALittleIsMeasuredAgainWithoutASearch) {
  addUpper(makeShape(singleBall(kRadius)));
  const double start = 0.5 + kRadius - 0.003;
  place(btVector3(0, 0, btScalar(start)));
  const ContactStatistics before = count();
  for (int i = 1; i <= 3; ++i) {
    const double move = 0.11 * i * spacing;
    place(btVector3(btScalar(move), 0, btScalar(start - move)));
    EXPECT_NEAR(depth(), 0.003 + move, 1e-4);
  }
  EXPECT_EQ(count().searched, before.searched);
  EXPECT_EQ(count().refined, before.refined + 3);
}

TEST_F(Coherence, ABallThatMovesMoreIsSearched) {
  addUpper(makeShape(singleBall(kRadius)));
  place(btVector3(0, 0, btScalar(0.5 + kRadius)));
  const ContactStatistics before = count();
  for (int i = 1; i <= 4; ++i) place(btVector3(btScalar(0.6 * i * spacing), 0, btScalar(0.5 + kRadius)));
  EXPECT_EQ(count().searched, before.searched + 4);
}

/// Until the contact law limits what it tells Bullet of the depth.
TEST_F(Coherence, DepthIsRightAllTheWayFromApartToTouching) {
  addUpper(makeShape(singleBall(kRadius)));
  for (int i = -90; i <= 40; ++i) {
    const double depth_now = 0.01 * i * spacing;
    place(btVector3(btScalar(0.2), btScalar(0.1), btScalar(0.5 + kRadius - depth_now)));
    EXPECT_NEAR(depth(), depth_now, 1e-4) << i;
  }
}

TEST_F(Coherence, ABallThatRollsSlowlyKeepsItsDepth) {
  addUpper(makeShape(singleBall(kRadius)));
  for (int i = 0; i <= 400; ++i) {
    const double way = 0.013 * i * spacing;
    place(btVector3(btScalar(way), 0, btScalar(0.5 + kRadius - 0.002)),
          btQuaternion(btVector3(0, 1, 0), btScalar(way / kRadius)));
    EXPECT_NEAR(depth(), 0.002, 1e-4) << i;
  }
}

/// Its contact stays under it, and pushes neither forwards nor back: in each step that is not measured, too.
TEST_F(Coherence, ABallRollsOnItsLowestPoint) {
  addUpper(makeShape(singleBall(kRadius)));
  place(btVector3(0, 0, btScalar(0.5 + kRadius - 0.002)));
  const auto point = [&]() -> const btManifoldPoint& {
    return world.dispatcher.getManifoldByIndexInternal(0)->getContactPoint(0);
  };
  ASSERT_EQ(world.contactCount(), 1);
  const btVector3 start = point().getPositionWorldOnB();
  const ContactStatistics before = count();
  for (int i = 1; i <= 9; ++i) {
    const double way = 0.001 * i * spacing;  // its turn is as large again
    place(btVector3(btScalar(way), 0, btScalar(0.5 + kRadius - 0.002)),
          btQuaternion(btVector3(0, 1, 0), btScalar(way / kRadius)));
    ASSERT_EQ(world.contactCount(), 1);
    EXPECT_NEAR(std::fabs(point().m_normalWorldOnB.z()), 1, 1e-6);
    EXPECT_NEAR(point().m_normalWorldOnB.x(), 0, 2e-6);
    EXPECT_NEAR(point().getPositionWorldOnB().x() - start.x(), way, 0.05 * way + 1e-6);
  }
  EXPECT_EQ(count().refined, before.refined);
  EXPECT_EQ(count().searched, before.searched);
}

TEST_F(Coherence, ABoxThatTiltsSlowlyGoesDownWithItsCorner) {
  addUpper(makeShape(latticeBox({0.6, 0.6, 0.6}, 6)));
  for (int i = 0; i <= 80; ++i) {
    const double tilt = 2e-4 * i;
    place(btVector3(0, 0, btScalar(0.5 + 0.3)), btQuaternion(btVector3(0, 1, 0), btScalar(tilt)));
    const double corner = 0.3 * (std::sin(tilt) + std::cos(tilt)) - 0.3;
    EXPECT_NEAR(depth(), corner, 2e-6) << i;
  }
}

/// Both bodies move, one against the other hardly.
TEST_F(Coherence, ContactsTurnWithThePair) {
  addUpper(makeShape(singleBall(kRadius)));
  place(btVector3(0, 0, btScalar(0.5 + kRadius - 0.003)));
  const ContactStatistics before = count();
  for (int i = 1; i <= 10; ++i) {
    const btTransform turn(btQuaternion(btVector3(1, 0, 0), btScalar(0.2 * i)), btVector3(0, btScalar(i), 0));
    lower->setWorldTransform(turn);
    world.world.updateSingleAabb(lower);
    const btTransform on_top =
        turn * btTransform(btQuaternion::getIdentity(), btVector3(0, 0, btScalar(0.997)));
    upper->setWorldTransform(on_top);
    world.world.performDiscreteCollisionDetection();
    EXPECT_NEAR(depth(), 0.003, 1e-5);
    ASSERT_EQ(world.contactCount(), 1);
    const btManifoldPoint& point = world.dispatcher.getManifoldByIndexInternal(0)->getContactPoint(0);
    EXPECT_NEAR(std::fabs(point.m_normalWorldOnB.dot(turn.getBasis().getColumn(2))), 1, 1e-5);
    EXPECT_LT(point.getPositionWorldOnB().distance(turn(btVector3(0, 0, btScalar(0.5)))), 0.005);
  }
  EXPECT_EQ(count().searched, before.searched);
}

}  // namespace
}  // namespace innersphere::test
