// Several threads collide pairs at once, as those of btCollisionDispatcherMt do where Bullet is built with
// threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <barrier>
#include <chrono>
#include <mutex>
#include <thread>
#include <vector>

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>

#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

/// Makes and releases manifolds at the end of a dispatch, as Bullet's does, but in the order in which one
/// thread would have done it. Pools are locked: Debian's are not.
class ConcurrentDispatcher : public btCollisionDispatcher {
 public:
  using btCollisionDispatcher::btCollisionDispatcher;

  btPersistentManifold* getNewManifold(const btCollisionObject* a, const btCollisionObject* b) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    btPersistentManifold* manifold = btCollisionDispatcher::getNewManifold(a, b);
    if (dispatching_) {
      m_manifoldsPtr.pop_back();
      changes_.push_back({pair_, manifold, false});
    }
    return manifold;
  }
  void releaseManifold(btPersistentManifold* manifold) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (dispatching_) {
      changes_.push_back({pair_, manifold, true});
    } else {
      btCollisionDispatcher::releaseManifold(manifold);
    }
  }
  void* allocateCollisionAlgorithm(int size) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    return btCollisionDispatcher::allocateCollisionAlgorithm(size);
  }
  void freeCollisionAlgorithm(void* memory) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    btCollisionDispatcher::freeCollisionAlgorithm(memory);
  }

  void dispatchAllCollisionPairs(btOverlappingPairCache* pairs, const btDispatcherInfo& info,
                                 btDispatcher*) override {
    constexpr int kThreads = 4;
    const int count = pairs->getNumOverlappingPairs();
    btBroadphasePair* const all = pairs->getOverlappingPairArrayPtr();
    std::atomic<int> next{0};
    std::barrier start(kThreads);
    const auto collide = [&] {
      start.arrive_and_wait();
      while ((pair_ = next++) < count) getNearCallback()(all[pair_], *this, info);
    };
    dispatching_ = true;
    std::vector<std::thread> threads;
    for (int i = 0; i < kThreads; ++i) threads.emplace_back(collide);
    for (std::thread& thread : threads) thread.join();
    dispatching_ = false;
    makeChanges();
  }

 private:
  struct Change {
    int pair;
    btPersistentManifold* manifold;
    bool released;
  };
  void makeChanges() {
    std::stable_sort(changes_.begin(), changes_.end(),
                     [](const Change& one, const Change& other) { return one.pair < other.pair; });
    for (const Change& change : changes_) {
      if (change.released) {
        btCollisionDispatcher::releaseManifold(change.manifold);
      } else {
        change.manifold->m_index1a = m_manifoldsPtr.size();
        m_manifoldsPtr.push_back(change.manifold);
      }
    }
    changes_.clear();
  }

  static thread_local int pair_;  ///< that the thread collides
  std::mutex mutex_;
  bool dispatching_ = false;
  std::vector<Change> changes_;
};
thread_local int ConcurrentDispatcher::pair_ = 0;

/// Falls and tumbles: packings, compounds of them, and boxes.
void addPile(TestWorld& world) {
  world.addFloor();
  const auto cube = makeShape(latticeBox({1, 1, 1}, 4));
  const auto pair = std::make_shared<btCompoundShape>();
  for (const int side : {-1, 1}) {
    const btTransform place(btQuaternion::getIdentity(), btVector3(btScalar(0.45 * side), 0, 0));
    pair->addChildShape(place, cube.get());
  }
  const auto box = std::make_shared<btBoxShape>(btVector3(btScalar(0.4), btScalar(0.4), btScalar(0.4)));
  world.add(cube, 0, btVector3(0, 0, btScalar(0.2)));
  for (int i = 0; i < 24; ++i) {
    const std::shared_ptr<btCollisionShape> shapes[] = {cube, cube, pair, box};
    const btVector3 at(btScalar(0.7 * (i % 3)), btScalar(0.8 * (i / 3 % 3)), btScalar(0.8 + 0.35 * i));
    world.add(shapes[i % 4], 1, at,
              btQuaternion(btVector3(1, btScalar(0.3 * i), 2).normalized(), btScalar(i)));
  }
}

class ConcurrentDispatch : public testing::TestWithParam<bool> {};

TEST_P(ConcurrentDispatch, MovesBodiesAsOneThreadDoes) {
  for (const Response response : {Response::compliant, Response::rigid}) {
    const auto motions = [&](const MakeDispatcher& make) {
      ContactOptions options;
      options.response = response;
      TestWorld world(options, make);
      if (GetParam()) {
        world.dispatcher.setNearCallback(
            [](btBroadphasePair& pair, btCollisionDispatcher& dispatcher, const btDispatcherInfo& info) {
              btCollisionDispatcher::defaultNearCallback(pair, dispatcher, info);
            });
      }
      addPile(world);
      std::vector<std::vector<btScalar>> all;
      for (int step = 0; step < 60; ++step) {
        world.run(1.0 / 60);
        all.push_back(world.motion());
      }
      EXPECT_GT(world.contactCount(), 30);
      return all;
    };
    const auto found = motions(make<ConcurrentDispatcher>), expected = motions(make<btCollisionDispatcher>);
    for (std::size_t step = 0; step < found.size(); ++step) ASSERT_EQ(found[step], expected[step]) << step;
  }
}

INSTANTIATE_TEST_SUITE_P(NearCallbacks, ConcurrentDispatch, testing::Bool(),
                         [](const auto& info) { return info.param ? "OfTheUser" : "OfBullet"; });

/// Gives other threads time to come in between when a body is about to be pushed.
class PushedDispatcher : public ConcurrentDispatcher {
 public:
  using ConcurrentDispatcher::ConcurrentDispatcher;
  bool needsResponse(const btCollisionObject* a, const btCollisionObject* b) override {
    std::this_thread::sleep_for(std::chrono::microseconds(100));
    return ConcurrentDispatcher::needsResponse(a, b);
  }
};

/// A push that another thread's writes over would be lost for one of the two bodies.
TEST(ConcurrentPenalty, ForcesKeepTheMomentum) {
  ContactOptions options;
  options.response = Response::penalty;
  TestWorld world(options, make<PushedDispatcher>);
  world.world.setGravity(btVector3(0, 0, 0));
  const auto cube = makeShape(latticeBox({btScalar(0.2), btScalar(0.2), btScalar(0.2)}, 2));
  world.add(makeShape(latticeBox({2, 2, btScalar(0.2)}, 8)), 10, btVector3(0, 0, 0));
  for (int i = 0; i < 64; ++i) {
    const btVector3 at(btScalar(0.25 * (i % 8) - 0.825), btScalar(0.25 * (i / 8) - 0.825), btScalar(0.19));
    world.add(cube, 1 + i % 3, at);
  }
  world.run(0.25);
  btVector3 momentum(0, 0, 0);
  btScalar moved = 0;
  for (const auto& body : world.bodies) {
    const btVector3 p = body->getLinearVelocity() / body->getInvMass();
    momentum += p;
    moved += p.length();
  }
  EXPECT_GT(moved, 0.1);
  EXPECT_LT(momentum.length(), 1e-5 * moved);
}

}  // namespace
}  // namespace innersphere::test
