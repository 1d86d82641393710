// What can be known of contacts, and changed: forces, volumes, materials.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <LinearMath/btSerializer.h>

#include "innersphere/bounded_query.hpp"
#include "innersphere/contact_drawer.hpp"
#include "innersphere/pair_overlaps.hpp"
#include "recipes/recipe_world.hpp"

namespace innersphere::recipes {
namespace {

TEST(Recipes, TheFloorCarriesTheWeight) {
  RecipeWorld<> simulation;
  auto& dispatcher = simulation.dispatcher;
  PackingCollisionAlgorithm::registerAlgorithm(&dispatcher);
  PackingShape shape(torusModel());
  simulation.add(shape, 2, btVector3(0, 0, btScalar(0.1)));
  simulation.run(2);
  btVector3 sum(0, 0, 0);
  // [snippet forces]
  for (const innersphere::PairOverlap& pair : innersphere::pairOverlaps(&dispatcher)) {
    std::printf("depth %g m, volume %g m^3, force %g N\n", double(pair.depth), pair.volume,
                double(pair.force.length()));
    sum += pair.force;  // on pair.b, which gets it from pair.a
  }
  // [snippet]
  EXPECT_NEAR(sum.length(), 2 * 9.81, 0.2);
}

/// What a user may keep with a body.
struct Material {
  btScalar friction;
};

TEST(Recipes, ACallbackSetsTheFriction) {
  for (const btScalar friction : {btScalar(0), btScalar(0.9)}) {
    RecipeWorld<> simulation;
    PackingCollisionAlgorithm::registerAlgorithm(&simulation.dispatcher);
    PackingShape shape(boxModel({0.4, 0.4, 0.2}));
    btRigidBody& body = simulation.add(shape, 1, btVector3(0, 0, btScalar(0.1)));
    body.setLinearVelocity(btVector3(1, 0, 0));
    Material ice{friction};
    // [snippet material]
    body.setUserPointer(&ice);
    body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
    gContactAddedCallback = [](btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                               const btCollisionObjectWrapper* b, int, int) {
      for (const auto* side : {a->getCollisionObject(), b->getCollisionObject()}) {
        if (const auto* material = static_cast<const Material*>(side->getUserPointer()))
          point.m_combinedFriction = material->friction;
      }
      return true;
    };
    // [snippet]
    simulation.run(0.5);
    gContactAddedCallback = nullptr;
    EXPECT_NEAR(body.getLinearVelocity().x(), friction > 0 ? 0 : 1, 0.02);
  }
}

/// Counts lines.
struct Lines : btIDebugDraw {
  void drawLine(const btVector3&, const btVector3&, const btVector3&) override { ++count; }
  void drawContactPoint(const btVector3&, const btVector3&, btScalar, int, const btVector3&) override {}
  void reportErrorWarning(const char*) override {}
  void draw3dText(const btVector3&, const char*) override {}
  void setDebugMode(int) override {}
  int getDebugMode() const override { return DBG_DrawWireframe; }
  int count = 0;
};

TEST(Recipes, ContactsAreDrawn) {
  RecipeWorld<> simulation;
  btDiscreteDynamicsWorld& world = simulation.world;
  PackingCollisionAlgorithm::registerAlgorithm(&simulation.dispatcher);
  PackingShape shape(torusModel());
  simulation.add(shape, 1, btVector3(0, 0, btScalar(kTubeRadius)));
  Lines lines;
  world.setDebugDrawer(&lines);
  simulation.run(1);
  world.debugDrawWorld();
  const int without = lines.count;
  // [snippet drawer]
  innersphere::ContactDrawer drawer(world);
  world.addAction(&drawer);  // world.debugDrawWorld() now shows patches, normals and shared volumes
  // [snippet]
  lines.count = 0;
  world.debugDrawWorld();
  EXPECT_GT(lines.count, without);
  world.removeAction(&drawer);
}

TEST(Recipes, AWorldIsSavedAsCompounds) {
  RecipeWorld<> simulation;
  btDiscreteDynamicsWorld& world = simulation.world;
  PackingShape shape(torusModel());
  simulation.add(shape, 1, btVector3(0, 0, 1));
  // [snippet save a world]
  btDefaultSerializer serializer;
  world.serialize(&serializer);
  std::size_t bytes = std::size_t(serializer.getCurrentBufferSize());
  // serializer.getBufferPointer() is a .bullet file: packings are in it as compounds of spheres
  // [snippet]
  EXPECT_GT(bytes, 256 * sizeof(btCompoundShapeChildData));
}

TEST(Recipes, AVolumeComesWithItsError) {
  constexpr bool kOverlapErrors = true;
  const std::shared_ptr<const CollisionModel> model = boxModel({1, 1, 1}, kOverlapErrors);
  // [snippet overlap]
  innersphere::QueryContext context;
  innersphere::BoundedQuery query(context);

  innersphere::PairQuery pair;  // any two models; no world is needed
  pair.a = pair.b = model.get();
  pair.placement_b.translation = {0.6, 0, 0};
  innersphere::QueryBudget budget;
  budget.seconds = 1e-3;
  innersphere::BoundedOverlap shared = query.overlap(pair, budget);
  std::printf("%g m^3, expected to be off by %g %%, in 19 of 20 cases by less than %g %%\n",
              shared.overlap.volume, 100 * shared.error, 100 * shared.error_bound);
  // [snippet]
  ASSERT_TRUE(std::isfinite(shared.error));
  EXPECT_GT(shared.error, 0);
  EXPECT_NEAR(shared.overlap.volume, 0.4, 0.4 * std::max(0.02, 4 * shared.error));
}

// Two unit cubes, of which one is moved along an edge: what they share is what is left of it.
TEST(Recipes, ASweepHasManyPoses) {
  const std::shared_ptr<const CollisionModel> model = boxModel({1, 1, 1});
  std::vector<double> matrices;
  for (int i = 0; i < 10000; ++i)
    matrices.insert(matrices.end(), {1, 0, 0, i / 1e4, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  // [snippet sweep]
  innersphere::PairQuery pair;
  pair.a = pair.b = model.get();
  innersphere::Poses poses;
  poses.count = 10000;
  poses.matrices = matrices.data();  // of B: 4 x 4 numbers each, row by row; or positions and quaternions
  std::vector<innersphere::Overlap> overlaps(poses.count);
  innersphere::QueryContext().sweep(pair, poses, {}, overlaps.data());  // overlaps[i].volume, .force, ...
  // [snippet]
  double sum = 0;
  for (const Overlap& overlap : overlaps) sum += overlap.volume;
  EXPECT_NEAR(sum / 10000, 0.5, 0.05);
  EXPECT_GT(overlaps[5000].force[0], 0);  // away from A
}

}  // namespace
}  // namespace innersphere::recipes
