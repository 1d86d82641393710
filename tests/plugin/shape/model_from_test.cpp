// A Bullet program's triangles to a body that collides.
#include <gtest/gtest.h>

#include "innersphere/bullet_mesh.hpp"
#include "innersphere/error.hpp"
#include "innersphere/packing_shape.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

/// A box with a corner at the origin.
void addBox(btTriangleMesh& triangles, const btVector3& size) {
  const auto corner = [&](int i) {
    return btVector3(i & 1 ? size.x() : 0, i & 2 ? size.y() : 0, i & 4 ? size.z() : 0);
  };
  const int faces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                            {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (const auto& f : faces) triangles.addTriangle(corner(f[0]), corner(f[1]), corner(f[2]));
}

TEST(ModelFrom, ATriangleMeshBecomesABodyThatRests) {
  btTriangleMesh triangles;
  addBox(triangles, btVector3(1, 2, 1));
  triangles.setScaling(btVector3(1, btScalar(0.5), 1));
  PackMeshOptions options;
  options.pack = startUpOptions(64);
  const auto shape = std::make_shared<PackingShape>(modelFrom(triangles, "box", options));
  EXPECT_NEAR(shape->model().packing().solid.volume, 1, 1e-6);
  EXPECT_EQ(shape->model().packing().spheres.size(), 64u);
  TestWorld world;
  world.addFloor();
  const btTransform mesh(btQuaternion::getIdentity(), btVector3(3, 4, btScalar(0.02)));
  btRigidBody& body =
      world.add(shape, 1, shape->bodyTransform(mesh).getOrigin(), shape->bodyTransform(mesh).getRotation());
  world.run(1);
  const btVector3 rests = shape->meshTransform(body.getWorldTransform()).getOrigin();
  EXPECT_LT(rests.distance(btVector3(3, 4, 0)), 0.002);
}

TEST(ModelFrom, OpenTrianglesAreAnError) {
  btTriangleMesh triangles;
  triangles.addTriangle(btVector3(0, 0, 0), btVector3(1, 0, 0), btVector3(0, 1, 0));
  try {
    modelFrom(triangles, "leaf");
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::not_a_solid);
  }
}

}  // namespace
}  // namespace innersphere::test
