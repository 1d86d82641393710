// Pairs of bodies that touch in several places: each has a manifold that lives on from step to step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kGravity = 9.81, kStep = 1.0 / 60;

/// Both as one body about the origin, whose moments do not matter.
Packing joined(Packing a, const Packing& b) {
  a.spheres.insert(a.spheres.end(), b.spheres.begin(), b.spheres.end());
  const auto first = std::uint32_t(a.surface.vertices.size());
  a.surface.vertices.insert(a.surface.vertices.end(), b.surface.vertices.begin(), b.surface.vertices.end());
  for (const auto& t : b.surface.triangles)
    a.surface.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  a.solid.volume = 1;
  a.solid.centre_of_mass = {};
  a.solid.inertia = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  return a;
}

/// A floor below z = 0 and, apart from it, a wall below x = 0.
std::shared_ptr<PackingShape> makeCorner() {
  return makeShape(
      joined(moved(latticeBox({2, 2, 2}, 12), {1.1, 0, -1}), moved(latticeBox({2, 2, 2}, 12), {-1, 0, 1.1})));
}

/// Two feet on both sides of the middle.
std::shared_ptr<PackingShape> makeFeet() {
  const Packing foot = latticeBox({0.4, 0.4, 0.4}, 4);
  return makeShape(joined(moved(foot, {0.7, 0, 0}), moved(foot, {-0.7, 0, 0})));
}

struct Patch {
  const btPersistentManifold* manifold;
  btVector3 place{0, 0, 0};
  double impulse = 0;  ///< of all points [N s]
  int life = 1 << 30;  ///< of the youngest point
};

/// From right to left.
std::vector<Patch> patchesOf(TestWorld& world) {
  std::vector<Patch> patches;
  for (int m = 0; m < world.dispatcher.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *world.dispatcher.getManifoldByIndexInternal(m);
    if (manifold.getNumContacts() == 0) continue;
    Patch patch{&manifold};
    for (int i = 0; i < manifold.getNumContacts(); ++i) {
      const btManifoldPoint& point = manifold.getContactPoint(i);
      patch.place += point.m_positionWorldOnB / btScalar(manifold.getNumContacts());
      patch.impulse += point.m_appliedImpulse;
      patch.life = std::min(patch.life, point.m_lifeTime);
    }
    patches.push_back(patch);
  }
  std::sort(patches.begin(), patches.end(),
            [](const Patch& a, const Patch& b) { return a.place.x() > b.place.x(); });
  return patches;
}

/// Two patches, with their manifolds and all points that they had `steps` before.
void expectKept(const std::vector<Patch>& before, const std::vector<Patch>& now, int steps) {
  ASSERT_EQ(before.size(), 2u);
  ASSERT_EQ(now.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(now[i].manifold, before[i].manifold);
    EXPECT_EQ(now[i].life, before[i].life + steps);
  }
}

class SeveralPatches : public testing::TestWithParam<DispatcherKind> {};

/// A cube of 1 kg in a corner, without friction, that leans on the wall: a pair with two directions.
struct CornerWorld : TestWorld {
  explicit CornerWorld(DispatcherKind kind) : TestWorld({}, kind) {
    add(makeCorner(), 0, btVector3(0, 0, 0));
    cube = &add(makeShape(latticeBox({1, 1, 1}, 6)), 1, btVector3(btScalar(0.5), 0, btScalar(0.5)));
    cube->setFriction(0);
    cube->setActivationState(DISABLE_DEACTIVATION);
    lean(kLean);
    run(1, kStep);
  }
  void lean(double towards_wall) {
    cube->setGravity(btVector3(btScalar(-towards_wall), 0, btScalar(-kGravity)));
  }
  static constexpr double kLean = 4;  // [m/s^2]
  btRigidBody* cube;
};

/// 1 kg on two feet, under a given stiffness: a pair with two places of one direction.
struct FeetWorld : TestWorld {
  explicit FeetWorld(DispatcherKind kind) : TestWorld(soft(), kind) {
    addFloor();
    body = &add(makeFeet(), 1, btVector3(0, 0, btScalar(0.2)));
    body->setActivationState(DISABLE_DEACTIVATION);
    run(1, kStep);
  }
  static ContactOptions soft() {
    ContactOptions options;
    options.stiffness = 2e4;
    return options;
  }
  btRigidBody* body;
};

TEST_P(SeveralPatches, OfTwoDirectionsKeepTheirManifoldsAndImpulses) {
  CornerWorld world(GetParam());
  const std::vector<Patch> start = patchesOf(world);
  for (int step = 1; step <= 20; ++step) {
    world.run(kStep, kStep);
    const std::vector<Patch> now = patchesOf(world);
    ASSERT_NO_FATAL_FAILURE(expectKept(start, now, step));
    EXPECT_NEAR(now[0].impulse, kGravity * kStep, 1e-3 * kGravity * kStep);
    EXPECT_NEAR(now[1].impulse, CornerWorld::kLean * kStep, 1e-3 * kGravity * kStep);
  }
}

TEST_P(SeveralPatches, OfOneDirectionKeepTheirManifoldsAndImpulses) {
  FeetWorld world(GetParam());
  const std::vector<Patch> start = patchesOf(world);
  for (int step = 1; step <= 20; ++step) {
    world.run(kStep, kStep);
    const std::vector<Patch> now = patchesOf(world);
    ASSERT_NO_FATAL_FAILURE(expectKept(start, now, step));
    for (const Patch& patch : now) EXPECT_NEAR(patch.impulse, kGravity / 2 * kStep, 1e-3 * kGravity * kStep);
  }
}

TEST_P(SeveralPatches, OneLivesOnWhileTheOtherGoesAndComesBack) {
  CornerWorld world(GetParam());
  const std::vector<Patch> start = patchesOf(world);
  ASSERT_EQ(start.size(), 2u);
  int alone = 0;
  for (int step = 1; step <= 90; ++step) {
    world.lean(step <= 20 ? -2 : CornerWorld::kLean);  // away from the wall, and back
    world.run(kStep, kStep);
    const std::vector<Patch> now = patchesOf(world);
    ASSERT_FALSE(now.empty());
    if (now.size() == 1) ++alone;
    EXPECT_EQ(now[0].manifold, start[0].manifold);
    EXPECT_EQ(now[0].life, start[0].life + step);
    EXPECT_NEAR(now[0].impulse, kGravity * kStep, 0.02 * kGravity * kStep);
  }
  EXPECT_GT(alone, 20);
  const std::vector<Patch> end = patchesOf(world);
  ASSERT_EQ(end.size(), 2u);
  EXPECT_LT(end[1].life, start[1].life);  // its points are new
  EXPECT_EQ(world.dispatcher.getNumManifolds(), 2);
}

TEST_P(SeveralPatches, AFootThatIsLiftedLeavesTheOtherItsManifold) {
  FeetWorld world(GetParam());
  const std::vector<Patch> start = patchesOf(world);
  ASSERT_EQ(start.size(), 2u);
  int alone = 0;
  for (int step = 1; step <= 90; ++step) {
    if (step <= 20) world.body->applyTorque(btVector3(0, btScalar(kGravity), 0));
    world.run(kStep, kStep);
    const std::vector<Patch> now = patchesOf(world);
    ASSERT_FALSE(now.empty());
    EXPECT_EQ(now[0].manifold, start[0].manifold);
    EXPECT_EQ(now[0].life, start[0].life + step);
    if (now.size() == 2) continue;
    ++alone;
    EXPECT_GT(now[0].impulse, 0);
  }
  EXPECT_GT(alone, 20);
  EXPECT_EQ(patchesOf(world).size(), 2u);
}

/// All that the solver is told and has found, in all steps.
std::vector<double> pileInACorner(DispatcherKind kind) {
  TestWorld world({}, kind);
  world.world.getDispatchInfo().m_deterministicOverlappingPairs = true;
  world.add(makeCorner(), 0, btVector3(0, 0, 0));
  const auto shape = makeShape(latticeBox({0.5, 0.5, 0.5}, 6));
  for (int i = 0; i < 6; ++i) {
    world
        .add(shape, 1,
             btVector3(btScalar(0.25 + 0.51 * (i % 2)), btScalar(0.02 * i), btScalar(0.26 + 0.51 * (i / 2))))
        .setGravity(btVector3(-4, 0, btScalar(-kGravity)));
  }
  constexpr int kSteps = 60;
  int between = 0;  // the corner and the cube in it, which are the first two bodies
  std::vector<double> all;
  for (int step = 0; step < kSteps; ++step) {
    world.run(kStep, kStep);
    for (int m = 0; m < world.dispatcher.getNumManifolds(); ++m) {
      const btPersistentManifold& manifold = *world.dispatcher.getManifoldByIndexInternal(m);
      const auto isOf = [&](int i) {
        return manifold.getBody0() == world.bodies[i].get() || manifold.getBody1() == world.bodies[i].get();
      };
      if (manifold.getNumContacts() > 0 && isOf(0) && isOf(1)) ++between;
      for (int i = 0; i < manifold.getNumContacts(); ++i) {
        const btManifoldPoint& point = manifold.getContactPoint(i);
        for (int k = 0; k < 3; ++k) all.push_back(point.m_positionWorldOnB[k]);
        all.insert(all.end(), {double(point.m_appliedImpulse), double(point.m_lifeTime)});
      }
    }
  }
  EXPECT_GE(between, 2 * (kSteps - 1));  // it starts above the floor
  return all;
}

TEST_P(SeveralPatches, DeterministicPairsMakeRecreatedWorldsEqual) {
  const std::vector<double> first = pileInACorner(GetParam());
  const std::vector<std::vector<char>> elsewhere(1000, std::vector<char>(200));  // other places in memory
  EXPECT_EQ(pileInACorner(GetParam()), first);
}

INSTANTIATE_TEST_SUITE_P(Dispatchers, SeveralPatches,
                         testing::Values(DispatcherKind::plain, DispatcherKind::multithreaded,
                                         DispatcherKind::batched),
                         [](const auto& info) { return nameOf(info.param); });

}  // namespace
}  // namespace innersphere::test
