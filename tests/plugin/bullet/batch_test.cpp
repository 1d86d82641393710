// How often the overlaps of packings are queried.
#include <gtest/gtest.h>

#include "innersphere/batched_dispatcher.hpp"
#include "innersphere/contact_statistics.hpp"
#include "innersphere/substep_solver.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

/// A world whose queries are counted from its start.
struct CountedWorld : TestWorld {
  explicit CountedWorld(DispatcherKind kind) : TestWorld({}, kind), start(now()) {}
  ContactStatistics now() { return contactStatistics(&dispatcher); }
  ContactStatistics start;
};

ContactStatistics countOf(CountedWorld& world) {
  ContactStatistics count = world.now();
  count.queries -= world.start.queries;
  count.searched -= world.start.searched;
  return count;
}

std::shared_ptr<PackingShape> cube() {
  return makeShape(latticeBox({1, 1, 1}, 6));
}

/// Cubes that keep moving, far enough into each other that all pairs exist from the first step.
void addPairs(TestWorld& world, int count) {
  const auto shape = cube();
  for (int i = 0; i < count; ++i) {
    world.add(shape, 0, btVector3(btScalar(3 * i), 0, btScalar(0.5)));
    world.add(shape, 1, btVector3(btScalar(3 * i), 0, btScalar(1.45)), btQuaternion(btVector3(0, 0, 1), 1))
        .setActivationState(DISABLE_DEACTIVATION);
  }
}

class Batch : public testing::TestWithParam<DispatcherKind> {
 protected:
  bool batched() const {
    return GetParam() == DispatcherKind::batched || GetParam() == DispatcherKind::batched_multithreaded;
  }
};

TEST_P(Batch, AStepIsOneLaunchForAllPairs) {
  CountedWorld world(GetParam());
  addPairs(world, 4);
  world.run(1.0 / 60);
  EXPECT_EQ(countOf(world).queries,
            batched() ? 1u : 4u);  // new pairs are not known before they are asked for
  EXPECT_EQ(countOf(world).searched, 4u);
  for (int i = 0; i < 5; ++i) {
    for (const auto& body : world.bodies) {  // all move in every step
      if (!body->isStaticObject()) body->setLinearVelocity(btVector3(1, 0, 0));
    }
    const ContactStatistics before = countOf(world);
    world.run(1.0 / 60);
    EXPECT_EQ(countOf(world).queries, before.queries + 1);
    EXPECT_EQ(countOf(world).searched, before.searched + 4);
  }
}

TEST_P(Batch, SleepingPairsCostNothing) {
  CountedWorld world(GetParam());
  world.addFloor();
  world.add(cube(), 1, btVector3(0, 0, btScalar(0.5)));
  btRigidBody& upper = world.add(cube(), 1, btVector3(0, 0, btScalar(1.5)));
  world.run(4);
  ASSERT_FALSE(upper.isActive());
  const ContactStatistics before = countOf(world);
  world.run(1);
  EXPECT_EQ(countOf(world).queries, before.queries);
  upper.activate();
  upper.setLinearVelocity(btVector3(1, 0, 0));
  world.run(0.1);
  EXPECT_GT(countOf(world).searched, before.searched);
}

TEST_P(Batch, PairsThatDoNotMoveAreNotQueriedAgain) {
  CountedWorld world(GetParam());
  addPairs(world, 2);
  for (const auto& body : world.bodies) body->setLinearFactor(btVector3(0, 0, 0));
  for (const auto& body : world.bodies) body->setAngularFactor(btScalar(0));
  world.run(0.1);
  const ContactStatistics before = countOf(world);
  EXPECT_GT(world.contactCount(), 0);
  world.run(0.5);
  EXPECT_EQ(countOf(world).queries, before.queries);
}

TEST_P(Batch, ChildrenOfCompoundsTakePart) {
  CountedWorld world(GetParam());
  const auto child = cube();
  btCompoundShape inner;
  inner.addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(2, 0, 0)), child.get());
  auto outer = std::make_shared<btCompoundShape>();
  outer->addChildShape(btTransform(btQuaternion(btVector3(0, 0, 1), btScalar(0.1)), btVector3(-1, 0, 0)),
                       child.get());
  outer->addChildShape(btTransform(btQuaternion(btVector3(0, 0, 1), btScalar(0.2)), btVector3(0, 0, 0)),
                       &inner);
  world.add(makeShape(latticeBox({8, 8, 1}, 4)), 0, btVector3(0, 0, btScalar(-0.5)));
  btRigidBody& body = world.add(outer, 1, btVector3(0, 0, btScalar(0.49)));
  body.setActivationState(DISABLE_DEACTIVATION);
  world.run(0.1);
  EXPECT_GT(world.contactCount(), 0);
  for (int i = 0; i < 5; ++i) {
    body.setLinearVelocity(btVector3(1, 0, 0));
    body.setAngularVelocity(btVector3(0, 0, 1));
    const ContactStatistics before = countOf(world);
    world.run(1.0 / 60);
    EXPECT_EQ(countOf(world).queries, before.queries + 1);
    EXPECT_EQ(countOf(world).searched, before.searched + 2);
  }
}

/// Contacts are wanted from further away then, though nothing has moved since the last query.
TEST_P(Batch, ABodyThatIsPushedIsSeenInTheSameStep) {
  CountedWorld world(GetParam());
  world.world.setGravity(btVector3(0, 0, 0));
  world.add(cube(), 0, btVector3(0, 0, 0));
  btRigidBody& upper = world.add(cube(), 1, btVector3(0, 0, btScalar(1.1)));
  world.run(0.05);
  EXPECT_EQ(world.contactCount(), 0);
  upper.setLinearVelocity(btVector3(0, 0, -20));
  world.run(1.0 / 60);
  EXPECT_GT(world.contactCount(), 0);
  EXPECT_GT(upper.getWorldTransform().getOrigin().z(), 0.99);
}

int refused = 0;

TEST_P(Batch, NearCallbacksStillFilter) {
  CountedWorld world(GetParam());
  addPairs(world, 1);
  refused = 0;
  world.dispatcher.setNearCallback(
      [](btBroadphasePair&, btCollisionDispatcher&, const btDispatcherInfo&) { ++refused; });
  world.run(0.1);
  EXPECT_GT(refused, 0);
  EXPECT_EQ(world.contactCount(), 0);
  EXPECT_LE(countOf(world).searched, 1u);  // looked at once, when it was new
  world.dispatcher.setNearCallback(btCollisionDispatcher::defaultNearCallback);
  world.run(0.1);
  EXPECT_GT(world.contactCount(), 0);
}

TEST_P(Batch, FiltersStillFilter) {
  CountedWorld world(GetParam());
  btRigidBody& floor = world.addFloor();
  btRigidBody& lower = world.add(cube(), 1, btVector3(0, 0, btScalar(0.5)));
  btRigidBody& upper = world.add(cube(), 1, btVector3(0, 0, btScalar(1.4)));
  upper.setIgnoreCollisionCheck(&lower, true);
  world.world.removeRigidBody(&floor);
  world.world.addRigidBody(&floor, btBroadphaseProxy::StaticFilter, btBroadphaseProxy::AllFilter);
  world.world.removeRigidBody(&lower);
  world.world.addRigidBody(&lower, btBroadphaseProxy::DebrisFilter, btBroadphaseProxy::DefaultFilter);
  world.run(0.5);
  EXPECT_LT(lower.getWorldTransform().getOrigin().z(), -0.5);  // its mask leaves out the floor
  EXPECT_NEAR(upper.getWorldTransform().getOrigin().z(), 0.5, 0.01);
  EXPECT_EQ(countOf(world).queries, 0u);
}

TEST_P(Batch, FiltersMayChangeTheirMind) {
  const auto pathOf = [](DispatcherKind kind) {
    TestWorld world({}, kind);
    world.addFloor();
    btRigidBody& lower = world.add(cube(), 1, btVector3(0, 0, btScalar(0.5)));
    btRigidBody& upper = world.add(cube(), 1, btVector3(btScalar(0.4), 0, btScalar(1.5)));
    std::vector<btScalar> heights;
    const auto runAnd = [&](bool ignore) {
      upper.setIgnoreCollisionCheck(&lower, ignore);
      lower.setIgnoreCollisionCheck(&upper, ignore);
      // Bullet leaves contacts to whoever changes a filter.
      world.world.getPairCache()->cleanProxyFromPairs(upper.getBroadphaseHandle(), &world.dispatcher);
      for (int i = 0; i < 30; ++i) {
        world.run(1.0 / 60);
        heights.push_back(upper.getWorldTransform().getOrigin().z());
      }
    };
    for (const bool ignore : {false, true}) runAnd(ignore);
    return heights;
  };
  const std::vector<btScalar> expected = pathOf(DispatcherKind::plain), found = pathOf(GetParam());
  EXPECT_NEAR(expected[29], 1.5, 0.01);
  EXPECT_LT(expected[59], 1);  // through the lower one
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-3) << i;
}

// Also where bodies come near each other: what a pair that is new in a step will do concerned the others, but
// only with a batched dispatcher, which knows of it sooner.
TEST_P(Batch, MovesBodiesAsThePlainDispatcherDoes) {
  for (const bool substeps : {false, true}) {
    const auto motion = [&](DispatcherKind kind) {
      TestWorld world({}, kind);
      SubstepSolver solver;
      if (substeps) world.world.setConstraintSolver(&solver);
      PackingCollisionAlgorithm::prepareWorld(world.world);
      world.addFloor();
      const auto shape = cube();
      for (int i = 0; i < 8; ++i)
        world.add(shape, 1,
                  btVector3(btScalar(0.3 * (i % 2)), btScalar(0.2 * (i % 3)), btScalar(0.8 + 1.2 * i)),
                  btQuaternion(btVector3(1, btScalar(0.3 * i), 2).normalized(), btScalar(i)));
      world.run(2);
      world.world.setConstraintSolver(&world.solver);
      return world.motion();
    };
    EXPECT_EQ(motion(GetParam()), motion(DispatcherKind::plain)) << substeps;
  }
}

/// Everything that a solver is told, and what it has found.
void append(const btPersistentManifold& manifold, std::vector<double>& all) {
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    const btManifoldPoint& point = manifold.getContactPoint(i);
    for (const btVector3* v : {&point.m_localPointA, &point.m_localPointB, &point.m_positionWorldOnA,
                               &point.m_positionWorldOnB, &point.m_normalWorldOnB})
      for (int k = 0; k < 3; ++k) all.push_back((*v)[k]);
    for (const double x :
         {double(point.m_distance1), double(point.m_combinedFriction), double(point.m_combinedRestitution),
          double(point.m_combinedContactStiffness1), double(point.m_combinedContactDamping1),
          double(point.m_appliedImpulse), double(point.m_contactPointFlags), double(point.m_lifeTime)})
      all.push_back(x);
  }
}

/// A look at all pairs writes manifolds with all threads, but where code of the user's has a part in it.
TEST_P(Batch, ManifoldsAreThoseThatAreWrittenOneByOne) {
  constexpr int kSteps = 120;
  const auto contacts = [](DispatcherKind kind, int one_by_one_from) {
    TestWorld world({}, kind);
    world.addFloor();
    const auto shape = cube();
    for (int i = 0; i < 8; ++i) {
      btRigidBody& body =
          world.add(shape, 1 + i % 2,
                    btVector3(btScalar(0.1 * (i % 3)), btScalar(0.4 * (i % 2)), btScalar(0.6 + 1.02 * i)),
                    btQuaternion(btVector3(0, 1, 1).normalized(), btScalar(0.3 * i)));
      body.setRestitution(btScalar(0.2 * (i % 3)));
      body.setFriction(btScalar(0.3 + 0.1 * i));
    }
    std::vector<double> all;
    for (int step = 0; step < kSteps; ++step) {
      if (step == one_by_one_from) {
        world.dispatcher.setNearCallback(
            [](btBroadphasePair& pair, btCollisionDispatcher& dispatcher, const btDispatcherInfo& info) {
              btCollisionDispatcher::defaultNearCallback(pair, dispatcher, info);
            });
      }
      world.run(1.0 / 60);
      for (int i = 0; i < world.dispatcher.getNumManifolds(); ++i)
        append(*world.dispatcher.getManifoldByIndexInternal(i), all);
    }
    return all;
  };
  const std::vector<double> expected = contacts(GetParam(), 0);
  EXPECT_GT(expected.size(), 10000u);
  EXPECT_EQ(contacts(GetParam(), kSteps), expected);
  EXPECT_EQ(contacts(GetParam(), kSteps / 2), expected);
}

INSTANTIATE_TEST_SUITE_P(Dispatchers, Batch,
                         testing::Values(DispatcherKind::plain, DispatcherKind::multithreaded,
                                         DispatcherKind::batched, DispatcherKind::batched_multithreaded),
                         [](const auto& info) { return nameOf(info.param); });

TEST(BatchedDispatcher, DoesWithoutARegistration) {
  btDefaultCollisionConfiguration configuration;
  BatchedDispatcher<> dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btCollisionWorld world(&dispatcher, &broadphase, &configuration);
  btSphereShape ball(1);
  btCollisionObject a, b;
  a.setCollisionShape(&ball);
  b.setCollisionShape(&ball);
  world.addCollisionObject(&a);
  world.addCollisionObject(&b);
  world.performDiscreteCollisionDetection();
  EXPECT_EQ(dispatcher.getNumManifolds(), 1);
  world.removeCollisionObject(&a);
  world.removeCollisionObject(&b);
}

}  // namespace
}  // namespace innersphere::test
