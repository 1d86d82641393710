// A packed body against every kind of shape of Bullet, whichever of the two was made first, with each
// dispatcher: it rests on it, and queries find it.
#include <gtest/gtest.h>

#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>

#include "bullet_shapes.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

using Case = std::tuple<std::string, bool, DispatcherKind>;

class ShapeMatrix : public testing::TestWithParam<Case> {
 protected:
  /// A unit cube at height z, on or in the shape.
  void build(btScalar z) {
    const auto& [name, cube_first, kind] = GetParam();
    world = std::make_unique<TestWorld>(ContactOptions{}, kind);
    btGImpactCollisionAlgorithm::registerAlgorithm(&world->dispatcher);
    PackingCollisionAlgorithm::registerAlgorithm(&world->dispatcher);
    ground_shape = makeBulletShape(name);
    const auto addCube = [&] {
      cube = &world->add(makeShape(latticeBox({1, 1, 1}, 8)), 1, btVector3(0, 0, z));
    };
    if (cube_first) addCube();
    ground =
        &world->add(ground_shape.shape, 0, ground_shape.place.getOrigin(), ground_shape.place.getRotation());
    if (!cube_first) addCube();
  }
  BulletShape ground_shape;
  std::unique_ptr<TestWorld> world;
  btRigidBody* ground = nullptr;
  btRigidBody* cube = nullptr;
};

TEST_P(ShapeMatrix, RestsOnIt) {
  build(btScalar(0.55));
  world->run(1.5);
  EXPECT_NEAR(cube->getWorldTransform().getOrigin().z(), 0.5, 0.005);
  EXPECT_LT(cube->getLinearVelocity().length(), 0.1);
  EXPECT_LT(tiltDegrees(*cube), 1);
}

struct Deepest : btCollisionWorld::ContactResultCallback {
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* first, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    if (-double(point.getDistance()) <= depth) return 0;
    depth = -double(point.getDistance());
    normal = point.m_normalWorldOnB;
    object = first->getCollisionObject();
    return 0;
  }
  double depth = -1e9;
  btVector3 normal{0, 0, 0};  // towards `object`
  const btCollisionObject* object = nullptr;
};

TEST_P(ShapeMatrix, QueriesFindIt) {
  build(btScalar(0.45));
  world->world.updateAabbs();
  for (const bool swapped : {false, true}) {
    Deepest found;
    world->world.contactPairTest(swapped ? ground : cube, swapped ? cube : ground, found);
    EXPECT_NEAR(found.depth, 0.05, 0.005);
    EXPECT_GT(found.normal.z() * (found.object == cube ? 1 : -1), 0.99);
  }
  Deepest found;
  world->world.contactTest(cube, found);
  EXPECT_NEAR(found.depth, 0.05, 0.005);
  EXPECT_EQ(world->dispatcher.getNumManifolds(), 0);
}

std::string caseName(const testing::TestParamInfo<Case>& info) {
  const auto& [name, cube_first, kind] = info.param;
  return name + (cube_first ? "_second" : "_first") + (kind == DispatcherKind::plain ? "" : "_Mt");
}

INSTANTIATE_TEST_SUITE_P(All, ShapeMatrix,
                         testing::Combine(testing::ValuesIn(bulletShapes()), testing::Bool(),
                                          testing::Values(DispatcherKind::plain,
                                                          DispatcherKind::multithreaded)),
                         caseName);

/// Nothing to rest on, and nothing that may crash.
class NoShape : public ShapeMatrix {};

TEST_P(NoShape, IsPassedThrough) {
  build(btScalar(0.3));
  world->run(0.5);
  EXPECT_LT(cube->getWorldTransform().getOrigin().z(), -0.5);
  Deepest found;
  world->world.contactPairTest(cube, ground, found);
  EXPECT_EQ(found.object, nullptr);
}

INSTANTIATE_TEST_SUITE_P(All, NoShape,
                         testing::Combine(testing::ValuesIn(emptyShapes()), testing::Bool(),
                                          testing::Values(DispatcherKind::plain)),
                         caseName);

}  // namespace
}  // namespace innersphere::test
