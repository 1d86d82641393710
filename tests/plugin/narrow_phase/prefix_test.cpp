// How many spheres collide, and what shapes of one model share.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "narrow_phase/contact_settings.hpp"
#include "shape/packing_shape_impl.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

std::shared_ptr<const CollisionModel> modelOf(Packing packing) {
  return std::make_shared<CollisionModel>(std::make_shared<const Packing>(std::move(packing)));
}

/// Spheres of a box, those in the half of negative x first.
std::shared_ptr<const CollisionModel> boxOfSpheres() {
  return modelOf(withoutSurface(latticeBox({2, 1, 1}, 8)));
}
constexpr std::size_t kHalf = 8 * 8 * 8 / 2;

double restsAt(TestWorld& world, btScalar x) {
  btRigidBody& body = world.add(makeShape(latticeBox({0.5, 0.5, 0.5}, 8)), 1, btVector3(x, 0, btScalar(0.8)));
  world.run(1);
  return body.getWorldTransform().getOrigin().z();
}

TEST(SphereCount, OnlyTheFirstSpheresCollideWithPackings) {
  const auto shape = std::make_shared<PackingShape>(boxOfSpheres());
  TestWorld world;
  world.add(shape, 0, btVector3(0, 0, 0));
  EXPECT_EQ(shape->sphereCount(), 2 * kHalf);
  shape->setSphereCount(kHalf);
  EXPECT_EQ(shape->sphereCount(), kHalf);
  EXPECT_NEAR(restsAt(world, btScalar(-0.5)), 0.75, 0.05);
  EXPECT_LT(restsAt(world, btScalar(0.5)), -1);
  shape->setSphereCount(0);  // and back, while the world runs
  EXPECT_EQ(shape->sphereCount(), 2 * kHalf);
  EXPECT_NEAR(restsAt(world, btScalar(0.5)), 0.75, 0.05);
}

TEST(SphereCount, OnlyTheFirstSpheresCollideWithOtherShapes) {
  const auto model = boxOfSpheres();
  for (const bool half : {true, false}) {
    const auto shape = std::make_shared<PackingShape>(model);
    if (half) shape->setSphereCount(kHalf);
    TestWorld world;
    world.add(shape, 0, btVector3(0, 0, 0));
    btRigidBody& ball = world.add(std::make_shared<btSphereShape>(btScalar(0.2)), 1,
                                  btVector3(btScalar(0.5), 0, btScalar(0.8)));
    ball.setAngularFactor(0);
    world.run(1);
    EXPECT_EQ(ball.getWorldTransform().getOrigin().z() < -1, half);
  }
}

TEST(SphereCount, ChangesAPairThatExists) {
  const auto shape = std::make_shared<PackingShape>(boxOfSpheres());
  TestWorld world;
  world.add(shape, 0, btVector3(0, 0, 0));
  btRigidBody& body =
      world.add(makeShape(latticeBox({0.5, 0.5, 0.5}, 8)), 1, btVector3(btScalar(0.5), 0, btScalar(0.75)));
  world.run(0.5);
  EXPECT_GT(body.getWorldTransform().getOrigin().z(), 0.6);
  shape->setSphereCount(kHalf);
  body.activate();
  world.run(1);
  EXPECT_LT(body.getWorldTransform().getOrigin().z(), -1);
}

TEST(SphereCount, IsAtMostWhatThereIs) {
  const auto shape = makeShape(latticeBox({1, 1, 1}, 3));
  shape->setSphereCount(1000);
  EXPECT_EQ(shape->sphereCount(), 27u);
}

TEST(SphereCount, BelongsToAShapeAndDataToTheModel) {
  const auto model = modelOf(latticeBox({1, 1, 1}, 4));
  const PackingShape coarse(model), fine(model);
  const_cast<PackingShape&>(coarse).setSphereCount(8);
  EXPECT_EQ(fine.sphereCount(), 64u);
  EXPECT_EQ(coarse.impl().solid, fine.impl().solid);
  EXPECT_EQ(&coarse.impl().surfaceQueries(), &fine.impl().surfaceQueries());
  EXPECT_EQ(&coarse.impl().solid->prefix(64).tree(), &fine.impl().prefix->tree());
  EXPECT_NE(makeShape(latticeBox({1, 1, 1}, 4))->impl().solid, fine.impl().solid);
}

TEST(SphereCount, SharedDataGoesWithTheLastShape) {
  const auto model = modelOf(latticeBox({1, 1, 1}, 4));
  std::weak_ptr<const PackedModel> solid;
  {
    const PackingShape shape(model);
    solid = shape.impl().solid;
    EXPECT_FALSE(solid.expired());
  }
  EXPECT_TRUE(solid.expired());
  EXPECT_EQ(model.use_count(), 1);
}

/// Large spheres at the corners of a grid, then ever smaller ones: gaps fall with the count.
Packing graded() {
  Packing packing = latticeBox({1, 1, 1}, 1);
  packing.spheres.clear();
  for (const int n : {4, 8, 16}) {
    const float r = 0.499999f / static_cast<float>(2 * n);
    for (int i = 0; i < n * n * n; ++i) {
      const auto at = [&](int k) { return static_cast<float>((k + 0.5) / n - 0.5); };
      packing.spheres.push_back({at(i % n), at(i / n % n), at(i / n / n), r});
    }
  }
  return packing;
}

/// The distance from the corner, edge and face centres of the cube to the nearest of the first spheres.
double largestGap(const Packing& packing, std::size_t count) {
  double gap = 0;
  for (int k = 0; k < 27; ++k) {
    const double p[3] = {k % 3 / 2.0 - 0.5, k / 3 % 3 / 2.0 - 0.5, k / 9 / 2.0 - 0.5};
    double nearest = 1e9;
    for (std::size_t i = 0; i < count; ++i) {
      const Sphere& s = packing.spheres[i];
      nearest = std::min(nearest, std::hypot(p[0] - s.x, p[1] - s.y, p[2] - s.z) - s.radius);
    }
    if (k != 13) gap = std::max(gap, nearest);
  }
  return gap;
}

TEST(Accuracy, TakesTheFewestSpheresThatMeetIt) {
  const Packing packing = graded();
  const auto shape = makeShape(packing);
  const btBoxShape box(btVector3(1, 1, 1));
  const auto countFor = [&](double accuracy, const btCollisionShape& other) {
    ContactOptions options;
    options.accuracy = accuracy;
    const ContactSettings measure(options, *shape, other, 0);
    return measure.prefix_a->count;
  };
  EXPECT_EQ(countFor(0, box), packing.spheres.size());
  EXPECT_EQ(countFor(10, box), 64u);
  EXPECT_EQ(countFor(1e-6, box), packing.spheres.size());
  for (const double accuracy : {0.2, 0.1, 0.08, 0.05, 0.04}) {
    const std::size_t count = countFor(accuracy, box);
    if (count < packing.spheres.size()) {
      EXPECT_LE(largestGap(packing, count), accuracy + 1e-6);
    }
    if (count > 64) {
      EXPECT_GT(largestGap(packing, count / 2), accuracy - 1e-6);
    }
    // Of two packings each may have half of it.
    EXPECT_EQ(countFor(2 * accuracy, *shape), count);
  }
  // In metres, whatever the size of the body.
  shape->setLocalScaling(btVector3(2, 2, 2));
  const std::size_t large = countFor(0.2, box);
  shape->setLocalScaling(btVector3(1, 1, 1));
  EXPECT_EQ(large, countFor(0.1, box));
  // Never more than the user allows.
  shape->setSphereCount(100);
  EXPECT_EQ(countFor(1e-6, box), 100u);
}

TEST(Accuracy, BodiesRestOnTheirSurfacesAllTheSame) {
  for (const double accuracy : {0.0, 0.3}) {
    ContactOptions options;
    options.accuracy = accuracy;
    TestWorld world(options);
    world.addFloor();
    const auto shape = makeShape(graded());
    btRigidBody& lower = world.add(shape, 1, btVector3(0, 0, btScalar(0.52)));
    btRigidBody& upper = world.add(shape, 1, btVector3(0, 0, btScalar(1.54)));
    world.run(2);
    EXPECT_NEAR(lower.getWorldTransform().getOrigin().z(), 0.5, 0.005) << accuracy;
    EXPECT_NEAR(upper.getWorldTransform().getOrigin().z(), 1.5, 0.01) << accuracy;
  }
}

TEST(OnlyWhatIsAskedFor, ABodyThatMeetsNothingHasNoTrees) {
  TestWorld world;
  const auto shape = makeShape(latticeBox({1, 1, 1}, 4));
  world.add(shape, 1, btVector3(0, 0, 0));
  world.add(shape, 1, btVector3(5, 0, 0));
  world.run(0.1);
  const PackedModel::Built none = shape->impl().solid->built();
  EXPECT_FALSE(none.sphere_bvh || none.surface_queries || none.vertex_hill_climb);

  // A ray needs the triangles and nothing else.
  btCollisionWorld::ClosestRayResultCallback ray(btVector3(0, 0, 5), btVector3(0, 0, -5));
  world.world.rayTest(ray.m_rayFromWorld, ray.m_rayToWorld, ray);
  EXPECT_TRUE(ray.hasHit());
  const PackedModel::Built rays = shape->impl().solid->built();
  EXPECT_TRUE(rays.surface_queries);
  EXPECT_FALSE(rays.sphere_bvh || rays.vertex_hill_climb);
}

TEST(OnlyWhatIsAskedFor, PackingsAmongThemselvesNeedNoTreeOfSpheres) {
  TestWorld world;
  const auto shape = makeShape(latticeBox({1, 1, 1}, 4));
  world.add(shape, 0, btVector3(0, 0, 0));
  world.add(shape, 1, btVector3(0, 0, 1));
  world.run(0.1);
  EXPECT_GT(world.contactCount(), 0);
  EXPECT_FALSE(shape->impl().solid->built().sphere_bvh);
}

}  // namespace
}  // namespace innersphere::test
