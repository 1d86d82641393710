// A packed body dropped on every kind of shape comes to rest on it, whichever of the two was made first.
#include <gtest/gtest.h>
#include <cmath>

#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>

#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

/// Something to fall on whose top is at z = top over the origin.
struct Ground {
  std::shared_ptr<btCollisionShape> shape;
  btVector3 position{0, 0, 0};
  double top = 0;
  std::shared_ptr<void> data = nullptr;  // what the shape refers to
};

Ground meshGround(bool flipped) {
  auto triangles = std::make_shared<btTriangleMesh>();
  constexpr int kCells = 8;
  const auto corner = [](int i, int j) {
    return btVector3(btScalar(i) - kCells / 2, btScalar(j) - kCells / 2, 0);
  };
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      const btVector3 a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1), d = corner(i, j + 1);
      if (flipped) {
        triangles->addTriangle(a, c, b);
        triangles->addTriangle(a, d, c);
      } else {
        triangles->addTriangle(a, b, c);
        triangles->addTriangle(a, c, d);
      }
    }
  }
  return {std::make_shared<btBvhTriangleMeshShape>(triangles.get(), true), btVector3(0, 0, 0), 0, triangles};
}

Ground makeGround(const std::string& name) {
  const btVector3 below(0, 0, -2);
  if (name == "plane") return {std::make_shared<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0))};
  if (name == "box") return {std::make_shared<btBoxShape>(btVector3(2, 2, 1)), btVector3(0, 0, -1)};
  if (name == "sphere") return {std::make_shared<btSphereShape>(2), below};
  if (name == "capsule") return {std::make_shared<btCapsuleShapeX>(2, 4), below};
  if (name == "cylinder") return {std::make_shared<btCylinderShapeZ>(btVector3(2, 2, 2)), below};
  if (name == "hull") {
    auto hull = std::make_shared<btConvexHullShape>();
    for (int i = 0; i < 8; ++i) {
      hull->addPoint(btVector3(btScalar(i & 1 ? 2 : -2), btScalar(i & 2 ? 2 : -2), btScalar(i & 4 ? 1 : -1)));
    }
    return {hull, btVector3(0, 0, -1), hull->getMargin()};  // in Bullet the margin is part of a hull
  }
  if (name == "mesh") return meshGround(false);
  if (name == "mesh wound the other way") return meshGround(true);
  if (name == "heightfield") {
    auto heights = std::make_shared<std::vector<float>>(32 * 32, 0.0f);
    auto field = std::make_shared<btHeightfieldTerrainShape>(32, 32, heights->data(), btScalar(-1),
                                                             btScalar(1), 2, false);
    return {field, btVector3(0, 0, 0), 0, heights};
  }
  if (name == "packing") return {makeShape(latticeBox({3, 3, 3}, 12)), btVector3(0, 0, btScalar(-1.5))};
  auto compound = std::make_shared<btCompoundShape>();
  std::shared_ptr<btCollisionShape> child;
  if (name == "compound of a box") child = std::make_shared<btBoxShape>(btVector3(2, 2, 1));
  if (name == "compound of a packing") child = makeShape(latticeBox({3, 3, 2}, 12));
  compound->addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, -1)), child.get());
  return {compound, btVector3(0, 0, 0), 0, child};
}

struct Body {
  std::shared_ptr<btCollisionShape> shape;
  std::shared_ptr<void> data;
};

/// All of them reach 0.5 m down from their centre.
Body makeBody(const std::string& name) {
  if (name == "box") return {makeShape(latticeBox({1, 1, 1}, 8)), nullptr};
  if (name == "spheres") return {makeShape(withoutSurface(latticeBox({1, 1, 1}, 8))), nullptr};
  if (name == "ball") return {makeShape(singleBall(0.5)), nullptr};
  auto compound = std::make_shared<btCompoundShape>();
  auto child = makeShape(latticeBox({1, 1, 1}, 8));
  compound->addChildShape(btTransform::getIdentity(), child.get());
  return {compound, child};
}

class FallThrough : public testing::TestWithParam<std::tuple<std::string, std::string, bool>> {};

TEST_P(FallThrough, ComesToRest) {
  const auto& [body_name, ground_name, body_first] = GetParam();
  const Ground ground = makeGround(ground_name);
  const Body dropped = makeBody(body_name);
  TestWorld world;
  btRigidBody* body = nullptr;
  const auto addBody = [&] {
    body = &world.add(dropped.shape, 1, btVector3(0, 0, btScalar(ground.top + 0.6)));
  };
  if (body_first) addBody();
  world.add(ground.shape, 0, ground.position);
  if (!body_first) addBody();

  world.run(2);
  const btVector3 at = body->getWorldTransform().getOrigin();
  const bool round = ground_name == "sphere" || ground_name == "capsule";
  // Packings without a surface meet as bare spheres, which sink between each other.
  const bool bare = body_name == "spheres" && ground_name.find("packing") != std::string::npos;
  EXPECT_NEAR(at.z(), ground.top + 0.5, bare ? 0.04 : 0.005);
  EXPECT_LT(body->getLinearVelocity().length(), round ? 0.1 : 0.05);
  if (!(round && body_name == "ball")) {
    // The ball is a polyhedron that may stand on a corner, 0.12 mm above its faces: it rolls off no faster
    // than sqrt(10/7 g h).
    const double farthest = body_name == "ball" ? 2 * std::sqrt(10.0 / 7 * 9.81 * 0.12e-3) : 0.02;
    EXPECT_LT(std::hypot(at.x(), at.y()), round ? 0.05 : farthest);
  }
  if (body_name != "ball") {
    EXPECT_LT(tiltDegrees(*body), 1);
  }
}

std::string caseName(const testing::TestParamInfo<FallThrough::ParamType>& info) {
  const auto& [body, ground, first] = info.param;
  std::string name = body + "_on_" + ground + (first ? "_body_first" : "_ground_first");
  for (char& c : name) c = c == ' ' ? '_' : c;
  return name;
}

INSTANTIATE_TEST_SUITE_P(Matrix, FallThrough,
                         testing::Combine(testing::Values("box", "spheres", "ball", "compound"),
                                          testing::Values("plane", "box", "sphere", "capsule", "cylinder",
                                                          "hull", "mesh", "mesh wound the other way",
                                                          "heightfield", "packing", "compound of a box",
                                                          "compound of a packing"),
                                          testing::Bool()),
                         caseName);

}  // namespace
}  // namespace innersphere::test
