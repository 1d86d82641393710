// All threads look at pairs at once, and find what one finds.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cfenv>
#include <chrono>
#include <thread>

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTriangleMesh.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "bullet_shapes.hpp"
#include "common/parallel.hpp"
#include "solver/crew.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr int kThreads = 8;

/// `job`, by so many threads, though the machine may have fewer.
template <typename Job>
void with(int threads, const Job& job) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  tbb::task_arena(threads).execute(job);
}

/// Turning cubes side by side, each in contact with `ground`.
void addCubes(TestWorld& world, const BulletShape& ground) {
  world.add(ground.shape, 0, ground.place.getOrigin(), ground.place.getRotation());
  const auto shape = makeShape(latticeBox({btScalar(0.2), btScalar(0.2), btScalar(0.2)}, 3));
  for (int i = 0; i < 36; ++i) {
    const btVector3 at(btScalar(0.3 * (i % 6 - 2.5)), btScalar(0.3 * (i / 6 - 2.5)), btScalar(0.1));
    world.add(shape, 1, at, btQuaternion(btVector3(0, 0, 1), btScalar(i)))
        .setAngularVelocity(btVector3(1, 0, 2));
  }
}

class Parallel : public testing::TestWithParam<std::string> {};

/// What a shape keeps while it is read must not get in the way of another reader.
TEST_P(Parallel, BodiesShareWhatTheyLieOn) {
  const auto places = [](int threads) {
    std::vector<std::array<btScalar, 3>> all;
    with(threads, [&] {
      TestWorld world;
      const BulletShape ground = makeBulletShape(GetParam());
      addCubes(world, ground);
      for (int step = 0; step < 10; ++step) {
        world.run(1.0 / 60);
        for (const auto& body : world.bodies) {
          const btVector3& at = body->getWorldTransform().getOrigin();
          all.push_back({at.x(), at.y(), at.z()});
        }
      }
      EXPECT_GT(world.contactCount(), 0);
    });
    return all;
  };
  EXPECT_EQ(places(kThreads), places(1));
}

INSTANTIATE_TEST_SUITE_P(All, Parallel, testing::ValuesIn(bulletShapes()),
                         [](const auto& info) { return info.param; });

/// A user's own mesh that only one may read at a time.
struct OneReaderMesh : btBvhTriangleMeshShape {
  explicit OneReaderMesh(btTriangleMesh* mesh) : btBvhTriangleMeshShape(mesh, true) {
    m_shapeType = CUSTOM_CONCAVE_SHAPE_TYPE;
  }
  void processAllTriangles(btTriangleCallback* callback, const btVector3& min,
                           const btVector3& max) const override {
    ++reads;
    if (++readers > 1) crowded = true;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
    btBvhTriangleMeshShape::processAllTriangles(callback, min, max);
    --readers;
  }
  mutable std::atomic<int> reads{0}, readers{0};
  mutable std::atomic<bool> crowded{false};
};

TEST(OwnShapes, AreAskedForTheirTrianglesByOneThreadAtATime) {
  btTriangleMesh mesh;
  mesh.addTriangle(btVector3(-4, -4, 0), btVector3(4, -4, 0), btVector3(0, 8, 0));
  const auto shape = std::make_shared<OneReaderMesh>(&mesh);
  with(kThreads, [&] {
    TestWorld world;
    addCubes(world, {shape});
    world.run(0.1);
  });
  EXPECT_GT(shape->reads, 36);
  EXPECT_FALSE(shape->crowded);
}

/// The rounding mode of this thread, while it lives.
struct Rounding {
  explicit Rounding(int mode) { std::fesetround(mode); }
  ~Rounding() { std::fesetround(before); }
  const int before = std::fegetround();
};

TEST(FloatingPointMode, IsThatOfTheCallerInAllThreads) {
  with(kThreads, [] {
    const Rounding upward(FE_UPWARD);
    std::atomic<int> calls{0}, in_other_modes{0};
    const auto look = [&](auto...) {
      ++calls;
      if (std::fegetround() != FE_UPWARD) ++in_other_modes;
    };
    inParallel(1000, look);
    inParallelBeside([](const std::atomic<bool>&) {}, 1000, look);
    Crew crew;
    crew.work(kThreads - 1, [&] {
      for (int stage = 0; stage < 1000; ++stage) crew.forEachPart(kThreads, look);
    });
    EXPECT_GE(calls, 3000);
    EXPECT_EQ(in_other_modes, 0);
  });
}

/// Who was the first to use the scheduler may have had another mode, as Embree has.
TEST(FloatingPointMode, OfTheSchedulerDoesNotMoveBodies) {
  const auto places = [](int mode) {
    std::vector<std::array<btScalar, 3>> all;
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, kThreads);
    tbb::task_arena arena(kThreads);
    {
      const Rounding rounding(mode);
      arena.initialize();
    }
    arena.execute([&] {
      const Rounding usual(FE_TONEAREST);  // the arena's is that of this thread, too
      TestWorld world;
      addCubes(world, makeBulletShape("box"));
      world.run(10.0 / 60);
      for (const auto& body : world.bodies) {
        const btVector3& at = body->getWorldTransform().getOrigin();
        all.push_back({at.x(), at.y(), at.z()});
      }
    });
    return all;
  };
  EXPECT_EQ(places(FE_UPWARD), places(FE_TONEAREST));
}

}  // namespace
}  // namespace innersphere::test
