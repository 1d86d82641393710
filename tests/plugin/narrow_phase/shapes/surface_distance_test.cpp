// Depth of one small ball against every kind of shape, where it is known.
#include <gtest/gtest.h>

#include <cmath>

#include "bullet_shapes.hpp"
#include "narrow_phase/shapes/shape_surface.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kRadius = 0.3;

std::vector<NearSphere> touchesAt(const btCollisionShape& shape, const btVector3& p) {
  Packing packing;
  packing.spheres = {{0, 0, 0, static_cast<float>(kRadius)}};
  const auto ball = makeShape(packing);
  const PlacedPacking body(*ball, btTransform(btQuaternion::getIdentity(), p), Estimator::raw, 0);
  std::vector<NearSphere> near_spheres;
  makeShapeSurface(shape)->findNearSpheres(body, btTransform::getIdentity(), near_spheres);
  return near_spheres;
}

void expectDistance(const btCollisionShape& shape, const btVector3& p, double distance,
                    const btVector3& normal) {
  const std::vector<NearSphere> near_spheres = touchesAt(shape, p);
  ASSERT_EQ(near_spheres.size(), distance < kRadius ? 1u : 0u)
      << shape.getName() << " at " << p.x() << " " << p.z();
  if (near_spheres.empty()) return;
  EXPECT_NEAR(near_spheres[0].distance, distance, 2e-3) << shape.getName();
  EXPECT_GT(near_spheres[0].normal.dot(normal.normalized()), 0.999) << shape.getName();
}

TEST(SurfaceDistance, Plane) {
  const btStaticPlaneShape plane(btVector3(0, 0, 1), 2);
  expectDistance(plane, btVector3(5, 6, btScalar(2.2)), 0.2, btVector3(0, 0, 1));
  expectDistance(plane, btVector3(5, 6, btScalar(1.5)), -0.5, btVector3(0, 0, 1));
  expectDistance(plane, btVector3(5, 6, btScalar(2.4)), 0.4, btVector3(0, 0, 1));
}

TEST(SurfaceDistance, Sphere) {
  const btSphereShape sphere(1);
  expectDistance(sphere, btVector3(btScalar(0.6), btScalar(0.8), btScalar(0)) * btScalar(1.1), 0.1,
                 btVector3(3, 4, 0));
  expectDistance(sphere, btVector3(btScalar(0.5), 0, 0), -0.5, btVector3(1, 0, 0));
}

TEST(SurfaceDistance, Box) {
  const btBoxShape box(btVector3(1, 2, 3));
  expectDistance(box, btVector3(btScalar(1.2), 0, 0), 0.2, btVector3(1, 0, 0));
  expectDistance(box, btVector3(btScalar(1.1), btScalar(-2.1), btScalar(3.1)), 0.1 * std::sqrt(3.0),
                 btVector3(1, -1, 1));
  expectDistance(box, btVector3(0, btScalar(-1.9), 0), -0.1, btVector3(0, -1, 0));
}

TEST(SurfaceDistance, Capsules) {
  const btCapsuleShape y(1, 2);
  expectDistance(y, btVector3(btScalar(1.2), btScalar(0.5), 0), 0.2, btVector3(1, 0, 0));
  expectDistance(y, btVector3(0, btScalar(2.1), 0), 0.1, btVector3(0, 1, 0));
  const btCapsuleShapeZ z(1, 2);
  expectDistance(z, btVector3(0, 0, btScalar(-1.5)), -0.5, btVector3(0, 0, -1));
}

TEST(SurfaceDistance, CylinderAndCone) {
  const btCylinderShapeZ cylinder(btVector3(1, 1, 2));
  expectDistance(cylinder, btVector3(btScalar(1.2), 0, btScalar(0.3)), 0.2, btVector3(1, 0, 0));
  expectDistance(cylinder, btVector3(btScalar(0.1), 0, btScalar(1.8)), -0.2, btVector3(0, 0, 1));
  // A cone of radius 1 and height 2 about z, its middle at the origin; the side has the normal (2, 0, 1).
  // Bullet adds the margin outside.
  btConeShapeZ cone(1, 2);
  cone.setMargin(0);
  const btVector3 out = btVector3(2, 0, 1).normalized();
  expectDistance(cone, btVector3(btScalar(0.5), 0, 0) + out * btScalar(0.15), 0.15, out);
  expectDistance(cone, btVector3(btScalar(0.2), 0, btScalar(-0.9)), -0.1, btVector3(0, 0, -1));
}

TEST(SurfaceDistance, Hull) {
  btConvexHullShape hull;
  for (int i = 0; i < 8; ++i) {
    hull.addPoint(btVector3(btScalar(i & 1 ? 1 : -1), btScalar(i & 2 ? 1 : -1), btScalar(i & 4 ? 1 : -1)));
  }
  hull.setMargin(btScalar(0.01));
  expectDistance(hull, btVector3(btScalar(0.3), btScalar(0.2), btScalar(1.11)), 0.1, btVector3(0, 0, 1));
  expectDistance(hull, btVector3(btScalar(0.3), btScalar(0.2), btScalar(0.8)), -0.21, btVector3(0, 0, 1));
}

TEST(SurfaceDistance, Sdf) {
  const auto ball = makeSdf(2, 16, [](const btVector3& p) { return double(p.length()) - 1; });
  expectDistance(*ball, btVector3(btScalar(0.6), btScalar(0.8), 0) * btScalar(1.1), 0.1, btVector3(3, 4, 0));
  expectDistance(*ball, btVector3(btScalar(0.5), btScalar(-0.5), btScalar(0.1)), std::sqrt(0.51) - 1,
                 btVector3(5, -5, 1));
  expectDistance(*ball, btVector3(0, 0, btScalar(1.4)), 0.4, btVector3(0, 0, 1));
  expectDistance(*ball, btVector3(0, 0, btScalar(2.1)), 1.1, btVector3(0, 0, 1));  // beyond the field
}

class MeshDistance : public testing::Test {
 protected:
  /// Floor z = 0 and wall x = 0, each of two triangles, for x > 0 and z > 0.
  MeshDistance() {
    const btScalar s = 4;
    const btVector3 o(0, -s, 0), x(s, -s, 0), z(0, -s, s), along(0, 2 * s, 0);
    mesh_.addTriangle(o, x, x + along);
    mesh_.addTriangle(o, x + along, o + along);
    mesh_.addTriangle(o, o + along, z + along);
    mesh_.addTriangle(o, z + along, z);
    shape_ = std::make_unique<btBvhTriangleMeshShape>(&mesh_, true);
  }
  btTriangleMesh mesh_;
  std::unique_ptr<btBvhTriangleMeshShape> shape_;
};

TEST_F(MeshDistance, FaceFromTheFront) {
  expectDistance(*shape_, btVector3(2, 0, btScalar(0.2)), 0.2, btVector3(0, 0, 1));
  expectDistance(*shape_, btVector3(2, 1, btScalar(0.25)), 0.25, btVector3(0, 0, 1));
}

TEST_F(MeshDistance, CornerTouchesFloorAndWall) {
  std::vector<NearSphere> near_spheres = touchesAt(*shape_, btVector3(btScalar(0.2), 0, btScalar(0.1)));
  ASSERT_EQ(near_spheres.size(), 2u);
  EXPECT_NEAR(near_spheres[0].distance, 0.1, 1e-5);
  EXPECT_GT(near_spheres[0].normal.z(), 0.999);
  EXPECT_NEAR(near_spheres[1].distance, 0.2, 1e-5);
  EXPECT_GT(near_spheres[1].normal.x(), 0.999);
}

TEST_F(MeshDistance, BesideTheRimIsOutside) {
  // Below the level of the floor, but beyond its end.
  const std::vector<NearSphere> near_spheres =
      touchesAt(*shape_, btVector3(btScalar(4.1), 0, btScalar(-0.1)));
  ASSERT_EQ(near_spheres.size(), 1u);
  EXPECT_NEAR(near_spheres[0].distance, 0.1 * std::sqrt(2.0), 1e-5);
  EXPECT_GT(near_spheres[0].normal.dot(btVector3(1, 0, -1).normalized()), 0.999);
}

TEST_F(MeshDistance, TheSideOfFirstContactIsKept) {
  // One large ball in front of the floor, one small one behind it: the centre of mass, in the large one,
  // decides.
  Packing packing;
  packing.spheres = {{0, 0, 0.5f, 0.65f}, {0, 0, -0.15f, 0.05f}};
  packing.solid.centre_of_mass = {0, 0, 0.4997};
  const auto shape = makeShape(packing);
  const btTransform frame = shape->principalTransform().inverse();
  const std::unique_ptr<ShapeSurface> surface = makeShapeSurface(*shape_);
  const auto at = [&](double z) {
    const btTransform place(btQuaternion::getIdentity(), btVector3(2, 0, btScalar(z)));
    std::vector<NearSphere> near_spheres;
    surface->findNearSpheres(PlacedPacking(*shape, place * frame, Estimator::raw, 0),
                             btTransform::getIdentity(), near_spheres);
    return near_spheres;
  };
  std::vector<NearSphere> near_spheres = at(0.12);
  ASSERT_EQ(near_spheres.size(), 1u + 1u);
  EXPECT_NEAR(near_spheres[1].distance, -0.03, 1e-5);
  EXPECT_GT(near_spheres[1].normal.z(), 0.999);
}

TEST(SurfaceDistance, ShapesWithoutASurfaceHaveNone) {
  struct Fluid : btSphereShape {
    Fluid() : btSphereShape(1) { m_shapeType = HFFLUID_SHAPE_PROXYTYPE; }
  } fluid;
  EXPECT_EQ(makeShapeSurface(fluid), nullptr);
}

}  // namespace
}  // namespace innersphere::test
