// From a mesh in memory to a shape, and where the mesh then is.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>

#include "innersphere/bullet_mesh.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/packing_file.hpp"
#include "recipes/recipe_world.hpp"

namespace innersphere::recipes {
namespace {

/// A box from the origin to (1, 2, 3), as a program may have it.
Mesh boxMesh() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertices.push_back({double(i & 1), 2.0 * (i >> 1 & 1), 3.0 * (i >> 2)});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

std::shared_ptr<const innersphere::CollisionModel> modelOf(const innersphere::Mesh& mesh) {
  // [snippet pack in a program]
  std::unique_ptr<innersphere::Solid> solid =
      innersphere::makeSolid(mesh, "crate");  // says what is wrong with a mesh
  innersphere::PackOptions options;
  options.spheres = 256;
  auto packing = std::make_shared<innersphere::Packing>(innersphere::pack(*solid, options));
  auto model = std::make_shared<innersphere::CollisionModel>(packing);
  // [snippet]
  return model;
}

TEST(Recipes, AMeshInMemoryBecomesAModel) {
  const PackingShape shape(modelOf(boxMesh()));
  EXPECT_EQ(shape.sphereCount(), 256u);
  EXPECT_NEAR(shape.model().packing().solid.volume, 6, 1e-9);
}

TEST(Recipes, TrianglesArePackedOnce) {
  const std::string cache = testing::TempDir() + "/recipe_cache";
  std::filesystem::remove_all(cache);
  ASSERT_EQ(setenv("XDG_CACHE_HOME", cache.c_str(), 1), 0);
  const Mesh mesh = boxMesh();
  std::vector<btScalar> vertices;
  std::vector<int> indices;
  for (const Vec3d& v : mesh.vertices)
    vertices.insert(vertices.end(), {btScalar(v[0]), btScalar(v[1]), btScalar(v[2])});
  for (const auto& t : mesh.triangles) indices.insert(indices.end(), {int(t[0]), int(t[1]), int(t[2])});
  btTriangleIndexVertexArray triangles(int(mesh.triangles.size()), indices.data(), 3 * sizeof(int),
                                       int(mesh.vertices.size()), vertices.data(), 3 * sizeof(btScalar));
  // [snippet from triangles]
  innersphere::PackMeshOptions options;
  options.cache_folder = innersphere::defaultCacheFolder();  // the next start reads what this one packs
  auto model = innersphere::modelFrom(triangles, "crate", options);  // those of a btGImpactMeshShape
  innersphere::PackingShape shape(model);
  // [snippet]
  EXPECT_EQ(shape.sphereCount(), 256u);
  EXPECT_NEAR(model->packing().solid.volume, 6, 1e-6);
  EXPECT_FALSE(std::filesystem::is_empty(cache + "/innersphere"));
}

TEST(Recipes, APackingIsReadFromItsFile) {
  const innersphere::Packing& packing = bracketModel()->packing();
  const std::string file = testing::TempDir() + "/recipe_bracket.cbor";
  // [snippet save a packing]
  innersphere::writePacking(packing, file, /*overwrite=*/true);
  innersphere::Packing same = innersphere::readPacking(file);
  // [snippet]
  EXPECT_EQ(same.spheres.size(), packing.spheres.size());
  EXPECT_EQ(same.spheres[7].x, packing.spheres[7].x);
}

TEST(Recipes, AMeshIsDrawnWhereItsBodyIs) {
  RecipeWorld<> simulation;
  btDiscreteDynamicsWorld& world = simulation.world;
  PackingCollisionAlgorithm::registerAlgorithm(&simulation.dispatcher);
  PackingShape shape(modelOf(boxMesh()));
  const btScalar mass = 1;
  btVector3 inertia;
  shape.calculateLocalInertia(mass, inertia);
  // [snippet place a mesh]
  btTransform mesh_pose(btQuaternion::getIdentity(), btVector3(0, 0, 1));  // where the mesh is to be
  btDefaultMotionState motion(mesh_pose, shape.meshToBody());
  btRigidBody body(mass, &motion, &shape, inertia);
  world.addRigidBody(&body);
  // after each step: motion.m_graphicsWorldTrans is where to draw the mesh
  // [snippet]
  simulation.run(3);
  // The mesh stands on its lower face: its own origin is on the floor, under where it was.
  const btTransform& drawn = motion.m_graphicsWorldTrans;
  EXPECT_LT(drawn.getOrigin().length(), 0.003);
  EXPECT_LT((drawn * btVector3(1, 2, 3) - btVector3(1, 2, 3)).length(), 0.005);
  world.removeRigidBody(&body);
}

TEST(Recipes, APlaceOfAMeshIsOneOfABody) {
  PackingShape shape(bracketModel());
  btRigidBody body(0, nullptr, &shape, btVector3(0, 0, 0));
  const btTransform mesh_pose(btQuaternion(btVector3(1, 2, 3).normalized(), 1), btVector3(4, 5, 6));
  // [snippet frames]
  body.setWorldTransform(shape.bodyTransform(mesh_pose));
  btTransform drawn = shape.meshTransform(body.getWorldTransform());
  // [snippet]
  EXPECT_LT((drawn.getOrigin() - mesh_pose.getOrigin()).length(), 1e-5);
  EXPECT_LT(drawn.getRotation().angle(mesh_pose.getRotation()), 1e-3);
  // Bullet's frame of a body is the principal one: the centre of mass of the solid is its origin.
  const Vec3d& centre = shape.model().packing().solid.centre_of_mass;
  const btVector3 middle{btScalar(centre[0]), btScalar(centre[1]), btScalar(centre[2])};
  EXPECT_GT(middle.length(), 0.01);
  EXPECT_LT((mesh_pose * middle - body.getWorldTransform().getOrigin()).length(), 1e-5);
}

}  // namespace
}  // namespace innersphere::recipes
