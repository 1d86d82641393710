// Dispatchers of a user's own, which filter pairs and count what they are asked for.
#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include <BulletCollision/CollisionDispatch/btCollisionDispatcherMt.h>

#include "innersphere/batched_dispatcher.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

struct Rules {
  virtual ~Rules() = default;
  const btCollisionObject* refused = nullptr;     ///< collides with nothing
  const btCollisionObject* unanswered = nullptr;  ///< has contacts, and nothing comes of them
  int dispatches = 0;
};

template <class Base>
class UsersDispatcher : public Base, public Rules {
 public:
  using Base::Base;

  bool needsCollision(const btCollisionObject* a, const btCollisionObject* b) override {
    return a != refused && b != refused && Base::needsCollision(a, b);
  }
  bool needsResponse(const btCollisionObject* a, const btCollisionObject* b) override {
    return a != unanswered && b != unanswered && Base::needsResponse(a, b);
  }
  void dispatchAllCollisionPairs(btOverlappingPairCache* pairs, const btDispatcherInfo& info,
                                 btDispatcher* dispatcher) override {
    ++dispatches;
    Base::dispatchAllCollisionPairs(pairs, info, dispatcher);
  }
};

struct Kind {
  std::string name;
  MakeDispatcher make;
};
const Kind kKinds[] = {
    {"Plain", make<UsersDispatcher<btCollisionDispatcher>>},
    {"Mt", make<UsersDispatcher<btCollisionDispatcherMt>>},
    {"Batched", make<BatchedDispatcher<UsersDispatcher<btCollisionDispatcher>>>},
    {"BatchedMt", make<BatchedDispatcher<UsersDispatcher<btCollisionDispatcherMt>>>},
    {"OfBatched", make<UsersDispatcher<BatchedDispatcher<>>>},
};

class UserDispatcher : public testing::TestWithParam<std::tuple<Kind, Response>> {};

TEST_P(UserDispatcher, FiltersAndCounts) {
  constexpr int kSteps = 30;
  for (const bool on_packing : {false, true}) {
    ContactOptions options;
    options.response = std::get<1>(GetParam());
    TestWorld world(options, std::get<0>(GetParam()).make);
    auto& rules = dynamic_cast<Rules&>(world.dispatcher);
    if (on_packing) {
      world.add(makeShape(latticeBox({8, 3, 2}, 12)), 0, btVector3(0, 0, -1));
    } else {
      world.addFloor();
    }
    const auto cube = makeShape(latticeBox({1, 1, 1}, 6));
    const auto add = [&](double x) -> btRigidBody& {
      return world.add(cube, 1, btVector3(btScalar(x), 0, btScalar(0.5)));
    };
    const btRigidBody &refused = add(-2), &unanswered = add(0), &other = add(2);
    rules.refused = &refused;
    rules.unanswered = &unanswered;
    int contacts = 0;
    for (int i = 0; i < kSteps; ++i) {
      world.run(1.0 / 60);
      for (int m = 0; m < world.dispatcher.getNumManifolds(); ++m) {
        const btPersistentManifold& manifold = *world.dispatcher.getManifoldByIndexInternal(m);
        EXPECT_FALSE(manifold.getBody0() == &refused || manifold.getBody1() == &refused);
        if (manifold.getBody0() == &unanswered || manifold.getBody1() == &unanswered)
          contacts += manifold.getNumContacts();
      }
    }
    EXPECT_EQ(rules.dispatches, kSteps);
    EXPECT_GT(contacts, kSteps);
    EXPECT_NEAR(refused.getLinearVelocity().z(), -9.81 * kSteps / 60, 1e-4);
    EXPECT_EQ(unanswered.getLinearVelocity().z(), refused.getLinearVelocity().z());
    EXPECT_GT(other.getWorldTransform().getOrigin().z(), 0.25);  // penalty forces bear it between spheres
  }
}

std::string nameOfCase(const testing::TestParamInfo<UserDispatcher::ParamType>& info) {
  return std::get<0>(info.param).name + nameOf(std::get<1>(info.param));
}

INSTANTIATE_TEST_SUITE_P(Kinds, UserDispatcher,
                         testing::Combine(testing::ValuesIn(kKinds),
                                          testing::Values(Response::compliant, Response::penalty)),
                         nameOfCase);

}  // namespace
}  // namespace innersphere::test
