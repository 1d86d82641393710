// Pairs whose boxes overlap but whose bodies are apart are left alone until something brings them together.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "innersphere/contact_statistics.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

const btQuaternion kEighth(btVector3(0, 0, 1), SIMD_PI / 4);
const btVector3 kTowards = btVector3(-1, -1, 0).normalized();
/// From the edge of the one to the face of the other along kTowards [m].
constexpr double kGap = 0.2;
const btScalar kDistance = btScalar(std::sqrt(0.5) + 0.5 + kGap);

/// A cube with its edge towards the face of another one, apart but with boxes that overlap.
struct Calm {
  explicit Calm(DispatcherKind kind, std::shared_ptr<btCollisionShape> lower)
      : world({}, kind), shape(makeShape(latticeBox({1, 1, 1}, 6))), ground(std::move(lower)) {
    world.world.setGravity(btVector3(0, 0, 0));
    world.add(ground, 0, btVector3(0, 0, 0));
    upper = &world.add(shape, 1, -kTowards * kDistance, kEighth);
    upper->setActivationState(DISABLE_DEACTIVATION);
    world.run(0.1, kStep);
  }
  void step(double dt = kStep) { world.run(dt, dt); }
  void place(double gap) {
    upper->setWorldTransform(btTransform(kEighth, -kTowards * btScalar(kDistance - kGap + gap)));
  }

  static constexpr double kStep = 1.0 / 240;
  TestWorld world;
  std::shared_ptr<PackingShape> shape;
  std::shared_ptr<btCollisionShape> ground;
  btRigidBody* upper;
};

std::shared_ptr<btCollisionShape> cube(bool packing) {
  if (packing) return makeShape(latticeBox({1, 1, 1}, 6));
  return std::make_shared<btBoxShape>(btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5)));
}

using Case = std::tuple<DispatcherKind, bool>;  ///< whether the lower cube is a packing, too

class CalmPairs : public testing::TestWithParam<Case> {
 protected:
  /// Contacts in the step after something has happened.
  int contactsAfter(const std::function<void(Calm&)>& event, double dt = Calm::kStep) const {
    const auto [kind, packing] = GetParam();
    Calm calm(kind, cube(packing));
    EXPECT_EQ(calm.world.dispatcher.getNumManifolds(), 0);
    EXPECT_EQ(calm.world.broadphase.getOverlappingPairCache()->getNumOverlappingPairs(), 1);
    event(calm);
    calm.step(dt);
    return calm.world.contactCount();
  }
};

TEST_P(CalmPairs, StayAsTheyAre) {
  EXPECT_EQ(contactsAfter([](Calm&) {}), 0);
}

TEST_P(CalmPairs, MeetWhenOneIsMoved) {
  EXPECT_GT(contactsAfter([](Calm& calm) { calm.place(-0.01); }), 0);
}

TEST_P(CalmPairs, MeetWhenOneIsTurned) {
  EXPECT_GT(
      contactsAfter([](Calm& calm) {
        calm.place(0.05);
        for (int i = 0; i < 5; ++i) calm.step();
        EXPECT_EQ(calm.world.contactCount(), 0);
        // An edge along the diagonal of its upper face leads to a corner.
        calm.upper->setWorldTransform(btTransform(
            kEighth * btQuaternion(btVector3(1, -1, 0).normalized(), btScalar(std::atan(std::sqrt(0.5)))),
            calm.upper->getWorldTransform().getOrigin()));
      }),
      0);
}

TEST_P(CalmPairs, MeetWhenOneIsPushed) {
  EXPECT_GT(contactsAfter([](Calm& calm) { calm.upper->setLinearVelocity(kTowards * 60); }), 0);
}

TEST_P(CalmPairs, MeetWhenStepsGetLonger) {
  EXPECT_GT(contactsAfter(
                [](Calm& calm) {
                  calm.upper->setLinearVelocity(kTowards);
                  calm.step();
                  EXPECT_EQ(calm.world.contactCount(), 0);
                },
                0.25),
            0);
}

TEST_P(CalmPairs, MeetWhenOneGrows) {
  EXPECT_GT(
      contactsAfter([](Calm& calm) { calm.shape->setLocalScaling(btVector3(1, 1, 1) * btScalar(1.4)); }), 0);
}

TEST_P(CalmPairs, MeetWhenAMarginGrows) {
  EXPECT_GT(contactsAfter([](Calm& calm) { calm.shape->setMargin(btScalar(1.1 * kGap)); }), 0);
}

TEST_P(CalmPairs, MeetWhenTheOtherGrows) {
  EXPECT_GT(contactsAfter([](Calm& calm) {
              calm.ground->setLocalScaling(btVector3(1, 1, 1) * btScalar(1.5));
              calm.world.world.updateSingleAabb(calm.world.bodies[0].get());
            }),
            0);
}

TEST_P(CalmPairs, MeetWhenOneGetsAnotherShape) {
  const auto large = makeShape(latticeBox({2, 2, 2}, 6));
  EXPECT_GT(contactsAfter([&](Calm& calm) { calm.upper->setCollisionShape(large.get()); }), 0);
}

/// A body that comes slowly is felt in time, and searched for now and then, not in every step.
TEST_P(CalmPairs, MeetWhenOneComesSlowly) {
  const auto [kind, packing] = GetParam();
  Calm calm(kind, cube(packing));
  const auto queries = [&] { return contactStatistics(&calm.world.dispatcher).searched; };
  const std::size_t before = queries();
  constexpr double kSpeed = 0.25;
  int steps = 0;
  while (calm.world.contactCount() == 0 && steps < 1000) {
    calm.upper->setLinearVelocity(kTowards * btScalar(kSpeed));
    calm.upper->setAngularVelocity(btVector3(0, 0, 0));
    calm.step();
    ++steps;
  }
  const double left = -calm.upper->getWorldTransform().getOrigin().dot(kTowards) - kDistance + kGap;
  EXPECT_GT(left, 0);
  EXPECT_LT(left, kGap / 4);
  EXPECT_GT(steps, 100);
  EXPECT_LT(queries() - before, 30u);
}

std::string caseName(const testing::TestParamInfo<Case>& info) {
  const auto [kind, packing] = info.param;
  return nameOf(kind) + (packing ? "_packing" : "_box");
}

INSTANTIATE_TEST_SUITE_P(
    Dispatchers, CalmPairs,
    testing::Combine(testing::Values(DispatcherKind::plain, DispatcherKind::multithreaded,
                                     DispatcherKind::batched, DispatcherKind::batched_multithreaded),
                     testing::Bool()),
    caseName);

}  // namespace
}  // namespace innersphere::test
