// What a heap of bodies that are deep in each other takes of memory, meanwhile and when it has come apart.
#include <gtest/gtest.h>

#include <malloc.h>

#include <algorithm>

#include <tbb/global_control.h>

#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

std::size_t bytesInUse() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

struct Memory {
  std::size_t most;   ///< while the bodies are deep in each other [bytes]
  std::size_t after;  ///< when they have come apart, and still are pairs for Bullet
};

/// Of a heap of boxes, all in nearly the same place, without what is there before its first step.
Memory heapOf(int count) {
  constexpr btScalar kStep = btScalar(1.0 / 60);
  TestWorld world;
  world.world.setGravity(btVector3(0, 0, 0));
  const auto shape = makeShape(latticeBox({1, 1, 1}, 8));
  const auto place = [&](btScalar apart) {
    for (int i = 0; i < count; ++i) {
      const btScalar turn = btScalar(i);
      const btVector3 at(btSin(turn), btSin(2 * turn), btCos(turn));
      world.bodies[std::size_t(i)]->setWorldTransform(
          btTransform(btQuaternion(turn, 2 * turn, 3 * turn), at * apart));
      world.bodies[std::size_t(i)]->setLinearVelocity(btVector3(0, 0, 0));
      world.bodies[std::size_t(i)]->setAngularVelocity(btVector3(0, 0, 0));
    }
  };
  for (int i = 0; i < count; ++i) {
    btRigidBody& body = world.add(shape, 1, btVector3(0, 0, 0));
    body.setActivationState(DISABLE_DEACTIVATION);
    body.setCollisionFlags(btCollisionObject::CF_NO_CONTACT_RESPONSE);  // so that the solver takes no memory
  }
  const std::size_t before = bytesInUse();
  Memory memory{0, 0};
  for (int step = 0; step < 4; ++step) {
    place(btScalar(0.05 + 0.001 * step));
    world.run(kStep, kStep);
    memory.most = std::max(memory.most, bytesInUse() - before);
  }
  EXPECT_GT(world.contactCount(), count);
  // Two of them go on to touch.
  for (int step = 0; step < 200; ++step) {
    place(100);
    world.bodies[1]->setWorldTransform(world.bodies[0]->getWorldTransform());
    world.bodies[1]->getWorldTransform().getOrigin() += btVector3(0, 0, btScalar(0.98 + 0.0001 * step));
    world.run(kStep, kStep);
  }
  memory.after = bytesInUse() - before;
  return memory;
}

TEST(MemoryOfAHeap, GrowsByLittleForEachPair) {
  // Each thread has room of its own to work in.
  const tbb::global_control two(tbb::global_control::max_allowed_parallelism, 2);
  heapOf(4);  // what all worlds share
  const Memory few = heapOf(12), many = heapOf(36);
  const double pairs = 36 * 35 / 2 - 12 * 11 / 2;
  RecordProperty("KB_a_pair", std::to_string((double(many.most) - double(few.most)) / pairs / 1024));
  RecordProperty("KB_after_few", std::to_string(double(few.after) / 1024));
  RecordProperty("KB_after", std::to_string(double(many.after) / 1024));
  // A pair of 512 spheres each has up to 1,024 contacts of spheres of 32 bytes in the result of the search,
  // and again in the query; and 100 samples with their lines, eight patches and Bullet's manifolds for
  // itself. Its tens of thousands of pairs of spheres, 92 bytes each, are not kept.
  EXPECT_LT(double(many.most) - double(few.most), pairs * 128 * 1024);
  // What stays is the room for a batch of usual size.
  EXPECT_LT(double(many.after), 4.0 * (1 << 20));
}

}  // namespace
}  // namespace innersphere::test
