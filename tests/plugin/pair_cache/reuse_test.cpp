// The rule that says what of a contact can be used again in a new step.
#include "pair_cache/reuse.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "pair_cache/pair_table.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kStep = 1.0 / 60;

/// A cube of 1 m over a box, 1 mm deep in it or apart, after contact was searched for.
class ReuseRule : public testing::Test {
 protected:
  void searchAt(double gap) {
    upper.setWorldTransform(at(gap));
    pair.set(wrapper(upper), wrapper(lower), false);
    body_a.emplace(upper, btScalar(kStep));
    body_b.emplace(lower, btScalar(kStep));
    pair.a.noteShape();
    pair.a.transform = upper.getWorldTransform();
    pair.b.transform = lower.getWorldTransform();
    static_cast<PackingVsShape&>(*pair.found).hasSameShapes();
    static_cast<PackingVsShape&>(*pair.found).search({}, pair.placed(), {});
    spacing = pair.found->settings->spacing;
    pair.safe = safeDistanceOf(pair, *body_a, *body_b);
  }
  Reuse ruleAfter(const btTransform& where, const btVector3& velocity = btVector3(0, 0, 0)) {
    upper.setWorldTransform(where);
    upper.setLinearVelocity(velocity);
    body_a->take(btScalar(kStep));
    return reuseOf(pair, *body_a, *body_b, btScalar(kStep));
  }
  static btTransform at(double gap, double aside = 0) {
    return btTransform(btQuaternion::getIdentity(), btVector3(btScalar(aside), 0, btScalar(1 + gap)));
  }
  static btCollisionObjectWrapper wrapper(const btRigidBody& body) {
    return {nullptr, body.getCollisionShape(), &body, body.getWorldTransform(), -1, -1};
  }

  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  std::shared_ptr<PackingShape> cube = makeShape(latticeBox({1, 1, 1}, 6));
  btBoxShape box{btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))};
  btRigidBody upper{1, nullptr, cube.get(), btVector3(1, 1, 1)};
  btRigidBody lower{0, nullptr, &box};
  ContactPair pair{&dispatcher};
  std::optional<BodySnapshot> body_a, body_b;
  double spacing = 0;
};

TEST_F(ReuseRule, BodiesInContactAreTransportedThenRefinedThenSearched) {
  searchAt(-0.001);
  ASSERT_FALSE(pair.found->memory.isEmpty());
  EXPECT_EQ(ruleAfter(at(-0.001)), Reuse::transport);
  EXPECT_EQ(ruleAfter(at(-0.001, 0.09 * spacing)), Reuse::transport);
  EXPECT_EQ(ruleAfter(at(-0.001, 0.11 * spacing)), Reuse::refine);
  EXPECT_EQ(ruleAfter(at(-0.001, 0.49 * spacing)), Reuse::refine);
  EXPECT_EQ(ruleAfter(at(-0.001, 0.51 * spacing)), Reuse::search);
  EXPECT_EQ(ruleAfter(at(-0.001)), Reuse::transport);  // the rule itself changes nothing
}

/// A turn by t moves a corner that is r from the middle by 2 r sin(t / 2).
TEST_F(ReuseRule, TurnsCountByHowFarTheyMoveTheSurface) {
  searchAt(-0.001);
  const auto turned = [](double angle) {
    return btTransform(btQuaternion(btVector3(0, 0, 1), btScalar(angle)), at(-0.001).getOrigin());
  };
  const double corner = std::sqrt(0.75);
  EXPECT_EQ(ruleAfter(turned(0.06 * spacing / corner)), Reuse::transport);
  EXPECT_EQ(ruleAfter(turned(0.6 * spacing / corner)), Reuse::search);
}

TEST_F(ReuseRule, BodiesThatMoveTogetherKeepTheirContacts) {
  searchAt(-0.001);
  const btTransform away(btQuaternion(btVector3(0, 1, 0), btScalar(0.8)), btVector3(3, -2, 7));
  lower.setWorldTransform(away);
  body_b->take(btScalar(kStep));
  EXPECT_EQ(ruleAfter(away * at(-0.001)), Reuse::transport);
}

TEST_F(ReuseRule, BodiesApartAreIdleAsLongAsTheyAreSlowAndHaveNotGoneFar) {
  searchAt(1);
  ASSERT_TRUE(pair.found->memory.isEmpty());
  ASSERT_TRUE(pair.safe.known);
  EXPECT_EQ(ruleAfter(at(1)), Reuse::idle);
  EXPECT_EQ(ruleAfter(at(1), btVector3(0, 0, btScalar(-0.4 * spacing / kStep))), Reuse::idle);
  EXPECT_EQ(ruleAfter(at(1), btVector3(0, 0, btScalar(-2 * spacing / kStep))), Reuse::search);
  EXPECT_EQ(ruleAfter(at(1 - 0.4 * spacing)), Reuse::idle);
  EXPECT_EQ(ruleAfter(at(1)), Reuse::transport);  // has travelled 0.8 spacings, and is back where it was
  EXPECT_EQ(ruleAfter(at(1 - 0.6 * spacing)), Reuse::search);
}

TEST_F(ReuseRule, SleepingBodiesAreNotIdleButOutOfUse) {
  searchAt(1);
  for (btRigidBody* body : {&upper, &lower}) body->setActivationState(ISLAND_SLEEPING);
  body_a->take(btScalar(kStep));
  body_b->take(btScalar(kStep));
  EXPECT_EQ(reuseOf(pair, *body_a, *body_b, btScalar(kStep)), Reuse::transport);
}

TEST_F(ReuseRule, AnotherShapeIsSearched) {
  for (const double gap : {-0.001, 1.0}) {
    searchAt(gap);
    cube->setMargin(btScalar(0.01) + cube->getMargin());
    EXPECT_EQ(ruleAfter(at(gap)), Reuse::search) << gap;
    searchAt(gap);
    cube->setSphereCount(cube->sphereCount() / 2);
    EXPECT_EQ(ruleAfter(at(gap)), Reuse::search) << gap;
    searchAt(gap);
    box.setLocalScaling(box.getLocalScaling() * btScalar(1.01));
    EXPECT_EQ(ruleAfter(at(gap)), Reuse::search) << gap;
    EXPECT_FALSE(pair.found->isKnown()) << gap;
  }
}

TEST_F(ReuseRule, AWiderSeparationIsSearched) {
  searchAt(0.001);
  EXPECT_EQ(ruleAfter(at(0.001)), Reuse::transport);
  pair.separation = btScalar(2 * spacing);
  EXPECT_EQ(ruleAfter(at(0.001)), Reuse::search);
}

TEST_F(ReuseRule, NothingLessIsDoneThanIsAllowed) {
  for (const double gap : {-0.001, 1.0}) {
    searchAt(gap);
    const Reuse usual = gap < 0 ? Reuse::transport : Reuse::idle;
    for (const Reuse least : {Reuse::idle, Reuse::transport, Reuse::refine, Reuse::search})
      EXPECT_EQ(reuseOf(pair, *body_a, *body_b, btScalar(kStep), least), std::max(usual, least));
  }
}

TEST_F(ReuseRule, ABodyAtNaNIsSearchedNotReused) {
  searchAt(-0.001);
  EXPECT_EQ(ruleAfter(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, btScalar(NAN)))),
            Reuse::search);
}

}  // namespace
}  // namespace innersphere::test
