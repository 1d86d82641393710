#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <utility>

#include <BulletDynamics/Vehicle/btRaycastVehicle.h>

#include "capture_log.hpp"
#include "innersphere/error.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

btQuaternion randomRotation(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  btQuaternion q(btScalar(normal(rng)), btScalar(normal(rng)), btScalar(normal(rng)), btScalar(normal(rng)));
  return q.normalized();
}

struct CountTriangles : btTriangleCallback {
  void processTriangle(btVector3* t, int, int) override {
    ++count;
    for (int i = 0; i < 3; ++i) {
      min.setMin(t[i]);
      max.setMax(t[i]);
    }
  }
  int count = 0;
  btVector3 min{BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT};
  btVector3 max{-BT_LARGE_FLOAT, -BT_LARGE_FLOAT, -BT_LARGE_FLOAT};
};

TEST(Shape, NullModelIsAnError) {
  try {
    PackingShape shape(nullptr);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
  }
}

TEST(Shape, BoundsContainEverySphereAndVertexInAnyPose) {
  const Packing packing = moved(latticeBox({1, 0.5, 0.25}, 3), {0.3, -0.2, 0.1});
  const auto shape = makeShape(packing);
  shape->setLocalScaling(btVector3(2, 2, 2));
  std::mt19937 rng(1);
  for (int trial = 0; trial < 50; ++trial) {
    const btTransform body(randomRotation(rng), btVector3(1, -2, 3));
    btVector3 min, max, sphere_centre;
    btScalar sphere_radius;
    shape->getAabb(body, min, max);
    shape->getBoundingSphere(sphere_centre, sphere_radius);
    const auto expectInside = [&](const btVector3& packing_point, double radius) {
      const btVector3 local = shape->principalTransform()(packing_point) * 2;
      const btVector3 world = body(local);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(world[axis] - radius, min[axis] - 1e-5);
        EXPECT_LE(world[axis] + radius, max[axis] + 1e-5);
      }
      EXPECT_LE(local.distance(sphere_centre) + radius, sphere_radius + 1e-5);
      EXPECT_LE(local.length() + radius, shape->getAngularMotionDisc() + 1e-5);
    };
    for (const Sphere& s : packing.spheres) expectInside(btVector3(s.x, s.y, s.z), 2 * s.radius);
    for (const auto& v : packing.surface.vertices) expectInside(btVector3(v[0], v[1], v[2]), 0);
  }
}

TEST(Shape, BoundsOfABoxAreTight) {
  const auto shape = makeShape(latticeBox({1, 2, 3}, 2));
  btVector3 min, max;
  shape->getAabb(btTransform::getIdentity(), min, max);
  EXPECT_NEAR((max - min).x() * (max - min).y() * (max - min).z(), 6, 1e-4);
}

TEST(Shape, MarginGrowsTheBounds) {
  const auto shape = makeShape(latticeBox({1, 1, 1}, 2));
  shape->setMargin(btScalar(0.1));
  btVector3 min, max;
  shape->getAabb(btTransform::getIdentity(), min, max);
  EXPECT_NEAR(max.x(), 0.6, 1e-5);
}

TEST(Shape, AMarginThatNoSearchCanHaveIsRefused) {
  const auto shape = makeShape(latticeBox({1, 1, 1}, 2));
  shape->setMargin(btScalar(0.1));
  for (const double margin : {-1e-6, -0.6, double(INFINITY), double(NAN)}) {
    try {
      shape->setMargin(btScalar(margin));
      ADD_FAILURE() << margin;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument) << margin;
    }
    EXPECT_EQ(shape->getMargin(), btScalar(0.1)) << margin;
  }
}

TEST(Shape, InertiaOfABoxIsExact) {
  const auto shape = makeShape(latticeBox({1, 2, 3}, 2));
  btVector3 inertia;
  shape->calculateLocalInertia(6, inertia);
  EXPECT_NEAR(inertia.x(), 0.5 * (4 + 9), 1e-4);
  EXPECT_NEAR(inertia.y(), 0.5 * (1 + 9), 1e-4);
  EXPECT_NEAR(inertia.z(), 0.5 * (1 + 4), 1e-4);
  shape->setLocalScaling(btVector3(2, 2, 2));
  shape->calculateLocalInertia(6, inertia);
  EXPECT_NEAR(inertia.z(), 4 * 0.5 * (1 + 4), 1e-3);
  shape->calculateLocalInertia(0, inertia);
  EXPECT_EQ(inertia.length2(), 0);
}

TEST(Shape, InertiaWithoutASolidIsThatOfTheSpheres) {
  Packing packing;
  packing.spheres = {{2, 0, 0, 1}, {-2, 0, 0, 1}};
  const auto shape = makeShape(packing);
  btVector3 inertia;
  shape->calculateLocalInertia(2, inertia);
  EXPECT_NEAR(inertia.x(), 2 * 0.4, 1e-5);
  EXPECT_NEAR(inertia.y(), 2 * (0.4 + 4), 1e-4);
  EXPECT_NEAR(inertia.z(), 2 * (0.4 + 4), 1e-4);
}

TEST(Shape, PrincipalFrameDiagonalisesATurnedSolid) {
  // A box of sizes 1, 2, 3, turned in its own frame and away from the origin.
  Packing packing = latticeBox({1, 2, 3}, 2);
  const btMatrix3x3 turn(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(0.7)));
  Mat3d tensor{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) tensor[3 * i + j] += turn[i][k] * packing.solid.inertia[4 * k] * turn[j][k];
    }
  }
  packing.solid.inertia = tensor;
  packing.solid.centre_of_mass = {5, 6, 7};
  const auto shape = makeShape(packing);
  const btTransform& principal = shape->principalTransform();
  EXPECT_NEAR(principal(btVector3(5, 6, 7)).length(), 0, 1e-4);
  EXPECT_NEAR(principal.getBasis().determinant(), 1, 1e-5);
  // Rotating the tensor into the frame leaves the moments of the box on the diagonal, in some order.
  btVector3 inertia;
  shape->calculateLocalInertia(6, inertia);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      double element = 0;
      for (int k = 0; k < 3; ++k) {
        for (int l = 0; l < 3; ++l) {
          element += principal.getBasis()[i][k] * tensor[3 * k + l] * principal.getBasis()[j][l];
        }
      }
      EXPECT_NEAR(element, i == j ? inertia[i] : 0, 2e-4);
    }
  }
}

TEST(Shape, PrincipalFrameOfACubeIsNotTurned) {
  Packing packing = latticeBox({1, 1, 1}, 2);
  packing.solid.inertia[1] = packing.solid.inertia[3] = 1e-8;
  EXPECT_EQ(makeShape(packing)->principalTransform().getBasis(), btMatrix3x3::getIdentity());
}

TEST(Shape, OnlyUniformScaling) {
  const auto shape = makeShape(latticeBox({1, 1, 1}, 2));
  shape->setLocalScaling(btVector3(2, 2, 2));
  shape->setLocalScaling(btVector3(3, 3, 3));  // absolute, not on top of the scaling before
  EXPECT_EQ(shape->getLocalScaling(), btVector3(3, 3, 3));
  for (const btVector3& bad : {btVector3(1, 2, 1), btVector3(0, 0, 0), btVector3(-1, -1, -1),
                               btVector3(1, 1, btScalar(std::nan("")))}) {
    try {
      shape->setLocalScaling(bad);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    }
  }
  EXPECT_EQ(shape->getLocalScaling(), btVector3(3, 3, 3));
}

TEST(Shape, ContactThresholdFollowsTheSpheresNotTheSize) {
  const auto coarse = makeShape(latticeBox({1, 1, 1}, 1));
  const auto fine = makeShape(latticeBox({1, 1, 1}, 50));
  EXPECT_NEAR(coarse->getContactBreakingThreshold(btScalar(0.02)), 0.02 * std::sqrt(0.75), 1e-5);
  EXPECT_NEAR(fine->getContactBreakingThreshold(btScalar(0.02)), 0.01, 1e-5);
}

TEST(Shape, TrianglesComeInTheFrameOfTheShape) {
  const auto shape = makeShape(moved(latticeBox({1, 1, 1}, 2), {10, 0, 0}));
  shape->setLocalScaling(btVector3(2, 2, 2));
  CountTriangles all;
  const btVector3 far(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
  shape->processAllTriangles(&all, -far, far);
  EXPECT_EQ(all.count, 12);
  EXPECT_NEAR((all.min - btVector3(-1, -1, -1)).length(), 0, 1e-4);
  EXPECT_NEAR((all.max - btVector3(1, 1, 1)).length(), 0, 1e-4);
  CountTriangles top;
  shape->processAllTriangles(&top, btVector3(-2, -2, btScalar(0.9)), btVector3(2, 2, 2));
  EXPECT_LT(top.count, 12);
  EXPECT_GE(top.count, 2);
}

TEST(Shape, NoSurfaceMeansNoTriangles) {
  const auto shape = makeShape(withoutSurface(latticeBox({1, 1, 1}, 2)));
  CountTriangles all;
  shape->processAllTriangles(&all, btVector3(-9, -9, -9), btVector3(9, 9, 9));
  EXPECT_EQ(all.count, 0);
}

TEST(Shape, RaysAndSweepsHitTheSurface) {
  TestWorld world;
  world.add(makeShape(latticeBox({1, 1, 1}, 2)), 1, btVector3(0, 0, 0));
  world.world.updateAabbs();
  const btVector3 from(btScalar(0.1), btScalar(0.2), 5), to(btScalar(0.1), btScalar(0.2), -5);
  btCollisionWorld::ClosestRayResultCallback ray(from, to);
  world.world.rayTest(from, to, ray);
  ASSERT_TRUE(ray.hasHit());
  EXPECT_NEAR(ray.m_closestHitFraction, 0.45, 1e-4);
  EXPECT_NEAR(ray.m_hitNormalWorld.z(), 1, 1e-4);

  btSphereShape ball(btScalar(0.2));
  btCollisionWorld::ClosestConvexResultCallback sweep(from, to);
  world.world.convexSweepTest(&ball, btTransform(btQuaternion::getIdentity(), from),
                              btTransform(btQuaternion::getIdentity(), to), sweep);
  ASSERT_TRUE(sweep.hasHit());
  EXPECT_NEAR(sweep.m_closestHitFraction, 0.43, 1e-3);
}

TEST(Shape, RaysGoOutOfIt) {
  TestWorld world;
  world.add(makeShape(latticeBox({1, 1, 1}, 2)), 1, btVector3(0, 0, 0));
  world.add(makeShape(latticeBox({1, 1, 1}, 2)), 1, btVector3(0, 0, 3));
  world.world.updateAabbs();
  const btVector3 inside(btScalar(0.1), btScalar(0.2), 0), up(0, 0, 9);
  btCollisionWorld::AllHitsRayResultCallback out(inside, inside + up), through(inside - up, inside + up);
  for (btCollisionWorld::AllHitsRayResultCallback* hits : {&out, &through})
    world.world.rayTest(hits->m_rayFromWorld, hits->m_rayToWorld, *hits);
  ASSERT_EQ(out.m_hitFractions.size(), 1);
  EXPECT_NEAR(out.m_hitPointWorld[0].z(), 2.5, 1e-4);  // where it goes into the next one
  ASSERT_EQ(through.m_hitFractions.size(), 2);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(through.m_hitNormalWorld[i].z(), -1, 1e-4);
}

// Each wheel stood on the car that it belongs to, which flew.
TEST(Shape, CarriesAVehicleAsABoxDoes) {
  const auto height = [](std::shared_ptr<btCollisionShape> shape) {
    constexpr double kStep = 1.0 / 240;
    TestWorld world;
    world.addFloor().setFriction(1);
    btRigidBody& chassis = world.add(std::move(shape), 800, btVector3(0, 0, 1));
    chassis.setActivationState(DISABLE_DEACTIVATION);
    const btRaycastVehicle::btVehicleTuning tuning;
    btDefaultVehicleRaycaster raycaster(&world.world);
    btRaycastVehicle vehicle(tuning, &chassis, &raycaster);
    vehicle.setCoordinateSystem(1, 2, 0);
    for (int i = 0; i < 4; ++i)
      vehicle.addWheel(btVector3(btScalar(i < 2 ? 0.8 : -0.8), btScalar(i % 2 ? 0.45 : -0.45), 0),
                       btVector3(0, 0, -1), btVector3(0, -1, 0), btScalar(0.4), btScalar(0.3), tuning, i < 2);
    world.world.addVehicle(&vehicle);
    world.run(4, kStep);
    world.world.removeVehicle(&vehicle);
    return double(chassis.getWorldTransform().getOrigin().z());
  };
  const btVector3 size(2, 1, btScalar(0.5));
  EXPECT_NEAR(height(makeShape(latticeBox({2, 1, 0.5}, 8))), height(std::make_shared<btBoxShape>(size / 2)),
              1e-3);
}

TEST(Shape, IsRecognisedAmongOthersOfItsType) {
  // Another shape that claims the same type number.
  struct Foreign : btStaticPlaneShape {
    explicit Foreign(int type) : btStaticPlaneShape(btVector3(0, 0, 1), 0) { m_shapeType = type; }
  };
  const auto shape = makeShape(latticeBox({1, 1, 1}, 2));
  const Foreign foreign(shape->getShapeType());
  const btBoxShape box(btVector3(1, 1, 1));
  EXPECT_EQ(PackingShape::from(shape.get()), shape.get());
  EXPECT_EQ(PackingShape::from(&foreign), nullptr);
  EXPECT_EQ(PackingShape::from(&box), nullptr);
  EXPECT_EQ(PackingShape::from(nullptr), nullptr);
  EXPECT_TRUE(shape->isConcave());
  EXPECT_NE(shape->getShapeType(), SDF_SHAPE_PROXYTYPE);
}

// Worlds that read the same packing each have a model of their own.
TEST(Shape, BareSurfaceIsToldOnceForEachPacking) {
  const CaptureLog log;
  for (const char* source : {"a bare box", "another bare box"}) {
    for (int world = 0; world < 2; ++world) {
      Packing packing = latticeBox({1, 1, 1}, 2);
      packing.provenance.source = source;
      Coverage& all = packing.coverage.emplace_back();
      all.count = static_cast<std::uint32_t>(packing.spheres.size());
      all.mean = all.p95 = all.max = 0.5;
      const auto shape = makeShape(packing);
      const auto again = makeShape(packing);
    }
  }
  ASSERT_EQ(log.messages.size(), 2u);
  EXPECT_NE(log.messages[0].find("\"a bare box\""), std::string::npos);
  EXPECT_NE(log.messages[1].find("\"another bare box\""), std::string::npos);
}

TEST(Shape, DebugDrawsItsSurface) {
  struct Lines : btIDebugDraw {
    void drawLine(const btVector3&, const btVector3&, const btVector3&) override { ++count; }
    void drawContactPoint(const btVector3&, const btVector3&, btScalar, int, const btVector3&) override {}
    void reportErrorWarning(const char*) override {}
    void draw3dText(const btVector3&, const char*) override {}
    void setDebugMode(int) override {}
    int getDebugMode() const override { return DBG_DrawWireframe; }
    int count = 0;
  } lines;
  TestWorld world;
  world.add(makeShape(latticeBox({1, 1, 1}, 2)), 1, btVector3(0, 0, 0));
  world.world.setDebugDrawer(&lines);
  world.world.debugDrawWorld();
  EXPECT_EQ(lines.count, 36);
}

}  // namespace
}  // namespace innersphere::test
