// From the contacts of spheres to patches: a cube on a plane, and sums of volumes.
#include "narrow_phase/contact_patches.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include <btBulletCollisionCommon.h>

#include "test_packings.hpp"

namespace innersphere::test {
namespace {

constexpr double kRounding = 5e-5;
const btVector3 kDown(0, 0, -1);

/// The caps that the plane z = 0 cuts from the spheres of a cube of 1 m, enlarged by a margin.
class CubeOnPlane {
 public:
  static constexpr int kCells = 6;

  explicit CubeOnPlane(double depth)
      : a_(*shape_, btTransform(btQuaternion::getIdentity(), btVector3(2, 3, btScalar(0.5 - depth))),
           Estimator::raw, btScalar(0.1)),
        surface_(makeShapeSurface(plane_)) {
    surface_->findNearSpheres(a_, world_, spheres_);
    for (const NearSphere& near : spheres_) {
      const double r = a_.searchRadius(near.sphere), s = near.distance, h = r - s;
      SphereContact contact;
      contact.sphere = near.sphere;
      contact.volume = float(M_PI * h * h * (3 * r - h) / 3);
      const btVector3 centre = a_.centreOf(near.sphere);
      contact.centroid = {float(centre.x()), float(centre.y()), float(-0.5 + depth - h / 3)};
      contact.area = {0, 0, float(-M_PI * (r * r - s * s))};
      contacts.push_back(contact);
    }
  }
  bool refine(std::vector<ContactPatch>& patches) {
    const ShapeProbe probe(a_, *surface_, world_, spheres_);
    const ContactSettings settings({}, *shape_, plane_, 0);
    selectSamples(contacts, probe, settings, {}, btMatrix3x3::getIdentity(), patches, samples);
    return refinePatches(samples, probe, settings, {}, patches);
  }

  std::vector<SphereContact> contacts;
  Samples samples;

 private:
  static std::shared_ptr<PackingShape> cube() {
    auto shape = makeShape(latticeBox({1, 1, 1}, kCells));
    shape->setMargin(0);
    return shape;
  }
  std::shared_ptr<PackingShape> shape_ = cube();
  btStaticPlaneShape plane_{btVector3(0, 0, 1), 0};
  btTransform world_ = btTransform::getIdentity();
  PlacedPacking a_;
  std::unique_ptr<ShapeSurface> surface_;
  std::vector<NearSphere> spheres_;
};

TEST(RefinePatches, BearsACubeAtItsCorners) {
  CubeOnPlane cube(0.003);
  std::vector<ContactPatch> patches;
  EXPECT_TRUE(cube.refine(patches));
  ASSERT_EQ(patches.size(), 1u);
  EXPECT_NEAR(patches[0].normal.distance(kDown), 0, kRounding);
  ASSERT_EQ(patches[0].count, kPatchPoints);
  for (int i = 0; i < kPatchPoints; ++i) {
    const ContactPoint& point = patches[0].points[i];
    EXPECT_NEAR(point.depth, 0.003, kRounding);
    EXPECT_NEAR(std::fabs(point.on_b.x()), 0.5, kRounding);
    EXPECT_NEAR(std::fabs(point.on_b.y()), 0.5, kRounding);
  }
  // The same points in the next step.
  const std::array<ContactPoint, kPatchPoints> before = patches[0].points;
  EXPECT_TRUE(cube.refine(patches));
  for (int i = 0; i < kPatchPoints; ++i) EXPECT_EQ(patches[0].points[i].id, before[std::size_t(i)].id);
}

TEST(RefinePatches, SaysWhetherAnythingIsNear) {
  std::vector<ContactPatch> patches;
  EXPECT_TRUE(CubeOnPlane(-0.005).refine(patches));
  patches.clear();
  EXPECT_FALSE(CubeOnPlane(-0.09).refine(patches));
}

TEST(SelectSamples, HasOnePatchForOneFace) {
  CubeOnPlane cube(0.003);
  std::vector<ContactPatch> patches;
  cube.refine(patches);
  ASSERT_EQ(cube.samples.patches.size(), 1u);
  EXPECT_EQ(cube.samples.lines.size(), cube.samples.indices.size());
  EXPECT_LT(cube.samples.indices.size(), cube.contacts.size());
}

TEST(VolumePatches, PushAsMuchAsTheVolume) {
  const CubeOnPlane cube(0.003);
  std::vector<ContactPatch> patches;
  volumePatches(cube.contacts, btScalar(0.01), btMatrix3x3::getIdentity(), patches);
  ASSERT_EQ(patches.size(), 1u);
  double volume = 0, area = 0, found = 0;
  for (const SphereContact& contact : cube.contacts) {
    volume += contact.volume;
    area -= contact.area[2];
  }
  ASSERT_EQ(patches[0].count, 4);
  for (int i = 0; i < 4; ++i) found += patches[0].points[i].depth * patches[0].area / 4;
  EXPECT_NEAR(patches[0].area, area, 1e-4 * area);
  EXPECT_NEAR(found, volume, 1e-3 * volume);
}

/// Two groups of contacts that face each other across a slot.
std::vector<SphereContact> slot(double left, double right) {
  std::vector<SphereContact> contacts;
  for (int side = 0; side < 2; ++side) {
    for (int i = 0; i < 9; ++i) {
      SphereContact contact;
      contact.centroid = {side ? 1.0F : -1.0F, float(i % 3) * 0.1F, float(i / 3) * 0.1F};
      contact.area = {float(side ? -right : left), 0, 0};
      contact.volume = 1e-4F;
      contacts.push_back(contact);
    }
  }
  return contacts;
}

TEST(VolumePatches, AreTwoInASlot) {
  std::vector<ContactPatch> patches;
  volumePatches(slot(0.01, 0.01), btScalar(0.01), btMatrix3x3::getIdentity(), patches);
  ASSERT_EQ(patches.size(), 2u);
  EXPECT_NEAR(patches[0].normal.dot(patches[1].normal), -1, 1e-5);
}

}  // namespace
}  // namespace innersphere::test
