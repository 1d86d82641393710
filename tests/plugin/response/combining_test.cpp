// How users change what Bullet makes of the properties of two bodies: their callbacks, and friction anchors.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>

#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kGravity = 9.81;

/// One of Bullet's global callbacks, and where points keep what it says.
struct Combiner {
  const char* name;
  CalculateCombinedCallback* callback;
  btScalar btManifoldPoint::*value;

  friend void PrintTo(const Combiner& combiner, std::ostream* out) { *out << combiner.name; }
};

constexpr btScalar kAnswer = btScalar(0.375);
std::thread::id asker;
std::atomic<int> asked, asked_elsewhere;

btScalar answer(const btCollisionObject*, const btCollisionObject*) {
  ++asked;
  if (std::this_thread::get_id() != asker) ++asked_elsewhere;
  std::this_thread::sleep_for(std::chrono::microseconds(50));  // others would have time to take a part
  return kAnswer;
}

class Combining : public testing::TestWithParam<Combiner> {
 protected:
  Combining() : before_(*GetParam().callback) {
    asker = std::this_thread::get_id();
    asked = asked_elsewhere = 0;
    *GetParam().callback = answer;
  }
  ~Combining() override { *GetParam().callback = before_; }

 private:
  const CalculateCombinedCallback before_;
};

TEST_P(Combining, UsersCallbackIsAskedByTheThreadThatDispatches) {
  TestWorld world;
  world.addFloor();
  const auto shape = makeShape(latticeBox({1, 1, 1}, 3));
  for (int i = 0; i < 16; ++i) {
    btRigidBody& cube = world.add(shape, 1, btVector3(btScalar(2 * i), 0, btScalar(0.499)));
    if (std::string(GetParam().name).find("Contact") == 0) cube.setContactStiffnessAndDamping(1e4, 10);
  }
  for (int step = 0; step < 3; ++step) {
    world.run(1.0 / 60);
    ASSERT_EQ(world.contactCount(), 16 * 4);
    for (int i = 0; i < world.dispatcher.getNumManifolds(); ++i) {
      const btPersistentManifold& manifold = *world.dispatcher.getManifoldByIndexInternal(i);
      for (int k = 0; k < manifold.getNumContacts(); ++k)
        EXPECT_EQ(manifold.getContactPoint(k).*GetParam().value, kAnswer);
    }
  }
  EXPECT_GE(asked, 3 * 16 * 4);
  EXPECT_EQ(asked_elsewhere, 0);
}

const Combiner kCombiners[] = {
    {"Friction", &gCalculateCombinedFrictionCallback, &btManifoldPoint::m_combinedFriction},
    {"Restitution", &gCalculateCombinedRestitutionCallback, &btManifoldPoint::m_combinedRestitution},
    {"RollingFriction", &gCalculateCombinedRollingFrictionCallback,
     &btManifoldPoint::m_combinedRollingFriction},
    {"SpinningFriction", &gCalculateCombinedSpinningFrictionCallback,
     &btManifoldPoint::m_combinedSpinningFriction},
    {"ContactDamping", &gCalculateCombinedContactDampingCallback,
     &btManifoldPoint::m_combinedContactDamping1},
    {"ContactStiffness", &gCalculateCombinedContactStiffnessCallback,
     &btManifoldPoint::m_combinedContactStiffness1},
};

INSTANTIATE_TEST_SUITE_P(All, Combining, testing::ValuesIn(kCombiners),
                         [](const auto& info) { return info.param.name; });

struct Law {
  const char* name;
  Response response;
  double stiffness;

  friend void PrintTo(const Law& law, std::ostream* out) { *out << law.name; }
};

class FrictionAnchor : public testing::TestWithParam<Law> {};

// Friction that holds is anchored in any case. Bullet's own anchors keep points as they were first found:
// bodies would sink in, and not bounce.
TEST_P(FrictionAnchor, ChangesNothing) {
  ContactOptions options;
  options.response = GetParam().response;
  options.stiffness = GetParam().stiffness;
  for (const double slope : {0.0, 0.4, 0.6}) {
    for (const double restitution : {0.0, 0.5}) {
      const auto way = [&](bool anchored) {
        TestWorld world(options);
        const double angle = std::atan(slope);
        world.world.setGravity(
            btVector3(btScalar(kGravity * std::sin(angle)), 0, btScalar(-kGravity * std::cos(angle))));
        world.addFloor().setRestitution(1);
        btRigidBody& cube =
            world.add(makeShape(latticeBox({1, 1, 0.5}, 6)), 1, btVector3(0, 0, btScalar(0.35)));
        cube.setRestitution(btScalar(restitution));
        if (anchored)
          cube.setCollisionFlags(cube.getCollisionFlags() | btCollisionObject::CF_HAS_FRICTION_ANCHOR);
        std::vector<btVector3> places;
        for (int step = 0; step < 120; ++step) {
          world.run(1.0 / 120, 1.0 / 120);
          places.push_back(cube.getWorldTransform().getOrigin());
        }
        return places;
      };
      EXPECT_EQ(way(false), way(true)) << slope << " " << restitution;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(With, FrictionAnchor,
                         testing::Values(Law{"compliant", Response::compliant, 0},
                                         Law{"stiffness", Response::compliant, 2e4},
                                         Law{"rigid", Response::rigid, 0},
                                         Law{"penalty", Response::penalty, 2e4}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace innersphere::test
