// contactTest and contactPairTest: true contacts, and no side effects, nor has anything else that only reads.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "innersphere/pair_overlaps.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

struct Collect : btCollisionWorld::ContactResultCallback {
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* object0, int, int,
                           const btCollisionObjectWrapper* object1, int, int) override {
    points.push_back(point);
    first = object0->getCollisionObject();
    second = object1->getCollisionObject();
    return 0;
  }
  double deepest() const {
    double depth = -1e9;
    for (const btManifoldPoint& p : points) depth = std::max(depth, -double(p.getDistance()));
    return depth;
  }
  std::vector<btManifoldPoint> points;
  const btCollisionObject* first = nullptr;
  const btCollisionObject* second = nullptr;
};

class ContactQuery : public testing::TestWithParam<bool> {
 protected:
  /// A unit cube 0.1 deep in the ground, which is the plane or another packing.
  void build(bool on_packing) {
    if (on_packing) {
      ground = &world.add(makeShape(latticeBox({2, 2, 2}, 10)), 0, btVector3(0, 0, -1));
    } else {
      ground = &world.addFloor();
    }
    cube = &world.add(makeShape(latticeBox({1, 1, 1}, 8)), 1, btVector3(0, 0, btScalar(0.4)));
    world.world.updateAabbs();
  }
  TestWorld world;
  btRigidBody* ground = nullptr;
  btRigidBody* cube = nullptr;
};

TEST_P(ContactQuery, PairTestFindsDepthAndDirectionInBothOrders) {
  build(GetParam());
  for (const bool swapped : {false, true}) {
    Collect found;
    world.world.contactPairTest(swapped ? ground : cube, swapped ? cube : ground, found);
    ASSERT_FALSE(found.points.empty());
    EXPECT_NEAR(found.deepest(), 0.1, 1e-3);
    for (const btManifoldPoint& p : found.points) {
      // From the second object, whatever the order, to the first.
      const double up = found.first == cube ? 1 : -1;
      EXPECT_NEAR(p.m_normalWorldOnB.z(), up, 1e-3);
      const btVector3 on_cube = found.first == cube ? p.getPositionWorldOnA() : p.getPositionWorldOnB();
      const btVector3 on_ground = found.first == cube ? p.getPositionWorldOnB() : p.getPositionWorldOnA();
      EXPECT_NEAR(on_cube.z(), -0.1, 2e-3);
      EXPECT_NEAR(on_ground.z(), 0, 2e-3);
    }
  }
}

TEST_P(ContactQuery, ContactTestFindsTheSame) {
  build(GetParam());
  Collect found;
  world.world.contactTest(cube, found);
  ASSERT_FALSE(found.points.empty());
  EXPECT_NEAR(found.deepest(), 0.1, 1e-3);
}

TEST_P(ContactQuery, HasNoSideEffects) {
  build(GetParam());
  Collect found;
  world.world.contactPairTest(cube, ground, found);
  world.world.contactTest(cube, found);
  EXPECT_EQ(world.dispatcher.getNumManifolds(), 0);
  EXPECT_EQ(cube->getLinearVelocity().length2(), 0);
  world.run(1.0 / 60);
  const int manifolds = world.dispatcher.getNumManifolds();
  const int contacts = world.contactCount();
  for (int i = 0; i < 3; ++i) world.world.contactPairTest(cube, ground, found);
  EXPECT_EQ(world.dispatcher.getNumManifolds(), manifolds);
  EXPECT_EQ(world.contactCount(), contacts);
}

TEST_P(ContactQuery, InsideACompound) {
  build(GetParam());
  auto child = makeShape(latticeBox({1, 1, 1}, 8));
  auto compound = std::make_shared<btCompoundShape>();
  compound->addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, 1)), child.get());
  btRigidBody& body = world.add(compound, 1, btVector3(0, 0, btScalar(-0.65)));
  world.world.updateAabbs();
  Collect found;
  world.world.contactPairTest(&body, ground, found);
  EXPECT_NEAR(found.deepest(), 0.15, 1e-3);
}

TEST_P(ContactQuery, NothingTouchesNothingFound) {
  build(GetParam());
  cube->setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, 2)));
  Collect found;
  world.world.contactPairTest(cube, ground, found);
  EXPECT_TRUE(found.points.empty());
}

TEST_P(ContactQuery, FindsBodiesThatAreAsFarApartAsAskedFor) {
  build(GetParam());
  cube->setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, btScalar(0.75))));
  Collect near;
  near.m_closestDistanceThreshold = btScalar(0.3);
  world.world.contactPairTest(cube, ground, near);
  ASSERT_FALSE(near.points.empty());
  EXPECT_NEAR(near.deepest(), -0.25, 1e-3);
  Collect nearer;
  nearer.m_closestDistanceThreshold = btScalar(0.2);
  world.world.contactPairTest(cube, ground, nearer);
  EXPECT_TRUE(nearer.points.empty());
}

INSTANTIATE_TEST_SUITE_P(Grounds, ContactQuery, testing::Bool(),
                         [](const auto& info) { return info.param ? "packing" : "plane"; });

class ReadingAWorld : public testing::TestWithParam<std::tuple<Response, DispatcherKind>> {
 protected:
  /// Packings, alone and in a compound, and a box, on a floor and on each other.
  static void fill(TestWorld& world) {
    world.addFloor();
    const auto cube = makeShape(latticeBox({1, 1, 1}, 5));
    const auto pair = std::make_shared<btCompoundShape>();
    for (const int side : {-1, 1}) {
      const btTransform place(btQuaternion::getIdentity(), btVector3(btScalar(0.5 * side), 0, 0));
      pair->addChildShape(place, cube.get());
    }
    const auto box = std::make_shared<btBoxShape>(btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5)));
    const std::shared_ptr<btCollisionShape> shapes[] = {cube, box, cube, pair, cube};
    for (int i = 0; i < 5; ++i) {
      world.add(shapes[i], 1,
                btVector3(btScalar(0.1 * i), btScalar(0.2 * (i % 2)), btScalar(0.55 + 1.05 * i)),
                btQuaternion(btVector3(0, 0, 1), btScalar(0.4 * i)));
    }
  }

  struct Found {
    std::size_t contacts = 0, rays = 0, sweeps = 0, overlaps = 0;
  };
  static void read(TestWorld& world, Found& all) {
    for (const auto& a : world.bodies) {
      Collect found;
      world.world.contactTest(a.get(), found);
      for (const auto& b : world.bodies) {
        // Bullet takes other ways through compounds where a distance is allowed.
        for (const btScalar distance : {btScalar(0), btScalar(0.1)}) {
          found.m_closestDistanceThreshold = distance;
          if (a != b) world.world.contactPairTest(a.get(), b.get(), found);
        }
      }
      all.contacts += found.points.size();
    }
    const btVector3 above(0, 0, 20), below(0, 0, -20);
    btCollisionWorld::AllHitsRayResultCallback hits(above, below);
    world.world.rayTest(above, below, hits);
    all.rays += static_cast<std::size_t>(hits.m_hitFractions.size());
    btCollisionWorld::ClosestConvexResultCallback hit(above, below);
    const btSphereShape ball(btScalar(0.2));
    world.world.convexSweepTest(&ball, btTransform(btQuaternion::getIdentity(), above),
                                btTransform(btQuaternion::getIdentity(), below), hit);
    all.sweeps += hit.hasHit() ? 1 : 0;
    all.overlaps += pairOverlaps(&world.dispatcher).size();
  }
};

TEST_P(ReadingAWorld, DoesNotMoveIt) {
  ContactOptions options;
  options.response = std::get<0>(GetParam());
  TestWorld read_world(options, std::get<1>(GetParam())), other(options, std::get<1>(GetParam()));
  fill(read_world);
  fill(other);
  Found found;
  for (int step = 0; step < 60; ++step) {
    read_world.run(1.0 / 60);
    other.run(1.0 / 60);
    ASSERT_EQ(read_world.motion(), other.motion()) << "after step " << step;
    read(read_world, found);
  }
  for (const std::size_t count : {found.contacts, found.rays, found.sweeps, found.overlaps})
    EXPECT_GE(count, 60u);
}

INSTANTIATE_TEST_SUITE_P(
    Responses, ReadingAWorld,
    testing::Combine(testing::Values(Response::compliant, Response::rigid, Response::penalty),
                     testing::Values(DispatcherKind::plain, DispatcherKind::batched)),
    [](const auto& info) { return nameOf(std::get<0>(info.param)) + "_" + nameOf(std::get<1>(info.param)); });

}  // namespace
}  // namespace innersphere::test
