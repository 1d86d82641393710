// Worlds that threads step, each its own, move as each does alone, also where they search together.
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "innersphere/query_queue.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

/// Cubes that fall on each other, in a number of worlds that differ in their steps.
std::vector<btScalar> motionOf(const ContactOptions& options, const std::shared_ptr<PackingShape>& cube,
                               std::size_t number) {
  TestWorld world(options, DispatcherKind::batched);
  world.add(cube, 0, btVector3(0, 0, 0));
  for (int i = 1; i < 4; ++i) {
    world.add(cube, 1, btVector3(btScalar(0.1 * i), 0, btScalar(1.01 * i)),
              btQuaternion(btVector3(0, 0, 1), btScalar(0.1) * btScalar(number)));
  }
  world.run(0.2 + 0.05 * static_cast<double>(number));
  return world.motion();
}

TEST(ManyWorlds, MoveAsEachDoesAlone) {
  constexpr std::size_t kWorlds = 5;
  const auto cube = makeShape(latticeBox({1, 1, 1}, 6));
  for (const Response response : {Response::compliant, Response::penalty}) {
    ContactOptions alone, together;
    alone.response = together.response = response;
    together.queue = std::make_shared<QueryQueue>();
    std::vector<std::vector<btScalar>> motions(kWorlds);
    std::vector<std::thread> threads;
    for (std::size_t w = 0; w < kWorlds; ++w)
      threads.emplace_back([&, w] { motions[w] = motionOf(together, cube, w); });
    for (std::thread& thread : threads) thread.join();
    for (std::size_t w = 0; w < kWorlds; ++w) EXPECT_EQ(motions[w], motionOf(alone, cube, w)) << w;
    EXPECT_GT(together.queue->calls(), kWorlds);
  }
}

}  // namespace
}  // namespace innersphere::test
