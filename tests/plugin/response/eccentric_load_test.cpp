// Loads beside the middle of a contact with a given stiffness, and the points that stand for its volume.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "narrow_phase/patch_moments.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kGravity = 9.81;

// A cube of n x n balls a face, d deep in a plane, has contacts of the area A = n^2 pi d (2 r - d) with the
// second moment I = A (1 - 1 / n^2) / 12. Under a torque M it tilts by M / (K I - m g h), as its weight at
// the height h leans over with it. The cut of the balls grows with their depth: up to a sixth of it at the
// rim here, which makes a hundredth of the tilt.
TEST(EccentricLoad, TiltsACubeAsTheAreaOfItsContactSays) {
  constexpr int kCells = 8;
  constexpr double kBall = 0.5 / kCells, kDepth = 0.02;
  const double volume = kCells * kCells * M_PI * kDepth * kDepth * (3 * kBall - kDepth) / 3;
  const double area = kCells * kCells * M_PI * kDepth * (2 * kBall - kDepth);
  const double second_moment = area * (1 - 1.0 / (kCells * kCells)) / 12;
  for (const Response response : {Response::compliant, Response::penalty}) {
    for (const double torque : {0.2, 0.5}) {
      ContactOptions options;
      options.response = response;
      options.stiffness = kGravity / volume;  // for 1 kg
      options.estimator = Estimator::raw;
      TestWorld world(options);
      world.addFloor();
      btRigidBody& cube =
          world.add(makeShape(latticeBox({1, 1, 1}, kCells)), 1, btVector3(0, 0, btScalar(0.5 - kDepth)));
      cube.setActivationState(DISABLE_DEACTIVATION);
      cube.setFriction(0);
      for (int step = 0; step < 720; ++step) {
        cube.applyTorque(btVector3(0, btScalar(torque), 0));
        world.run(1.0 / 240, 1.0 / 240);
      }
      const btVector3 up = cube.getWorldTransform().getBasis().getColumn(2);
      const double expected = torque / (options.stiffness * second_moment - kGravity * (0.5 - kDepth));
      EXPECT_NEAR(std::atan2(double(up.x()), double(up.z())), expected, 0.02 * expected) << torque;
      EXPECT_NEAR(0.5 - cube.getWorldTransform().getOrigin().z(), kDepth, 0.01 * kDepth);
    }
  }
}

constexpr double kSize[2] = {0.4, 0.2};  // [m]
constexpr double kDepth = 0.01;          // [m], in the middle

/// Contacts of the columns of a slab that is deeper on one side, and their sums.
struct Slab {
  explicit Slab(double slope_u, double slope_v) {
    constexpr int kColumns = 40;
    constexpr double kColumn = kSize[0] * kSize[1] / (kColumns * kColumns);
    for (int i = 0; i < kColumns; ++i) {
      for (int j = 0; j < kColumns; ++j) {
        const double u = kSize[0] * ((i + 0.5) / kColumns - 0.5), v = kSize[1] * ((j + 0.5) / kColumns - 0.5);
        const double volume = kColumn * (kDepth + slope_u * u + slope_v * v);
        const btVector3 from_centre = frame.getColumn(0) * btScalar(u) + frame.getColumn(1) * btScalar(v);
        SphereContact contact;
        contact.volume = float(volume);
        for (int k = 0; k < 3; ++k) {
          contact.centroid[k] = float(centre[k] + from_centre[k]);
          contact.area[k] = float(frame[k][2] * kColumn);
        }
        indices.push_back(contacts.size());
        contacts.push_back(contact);
        volume_sum += volume;
        moment += from_centre * btScalar(volume);
      }
    }
  }
  const btMatrix3x3 frame{btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(0.7))};
  const btVector3 centre{btScalar(0.3), btScalar(-0.2), btScalar(0.1)};
  std::vector<SphereContact> contacts;
  std::vector<std::size_t> indices;
  double volume_sum = 0;
  btVector3 moment{0, 0, 0};  ///< of the volume about the centre
};

TEST(PatchMoments, AreThoseOfASlopingSlab) {
  const Slab slab(0.03, -0.02);
  const PatchMoments m = patchMoments(slab.contacts, slab.indices, slab.frame);
  const double area = kSize[0] * kSize[1];
  EXPECT_NEAR(m.volume, kDepth * area, 1e-5 * kDepth * area);
  EXPECT_NEAR(m.area, area, 1e-5 * area);
  EXPECT_LT(m.normal.distance(slab.frame.getColumn(2)), 1e-5);
  EXPECT_LT(m.centre.distance(slab.centre), 1e-5);
  EXPECT_NEAR(m.spread[0] + m.spread[2], (kSize[0] * kSize[0] + kSize[1] * kSize[1]) / 12, 2e-5);
  const btVector3 slope = m.tangent[0] * m.slope[0] + m.tangent[1] * m.slope[1];
  EXPECT_LT(slope.distance(slab.frame * btVector3(btScalar(0.03), btScalar(-0.02), 0)), 1e-4);
}

// Each point stands for a quarter of the area.
TEST(PatchMoments, PointsHaveTheForceAndTheTorqueOfTheVolume) {
  for (const double steep : {0.0, 0.3, 1.0}) {  // at 1 the slab ends where the depth does
    const Slab slab(steep * 2 * kDepth / kSize[0], 0);
    ContactPatch patch;
    pointsFromMoments(patchMoments(slab.contacts, slab.indices, slab.frame), btScalar(1e-3), patch);
    ASSERT_EQ(patch.count, 4);
    const double quarter = kSize[0] * kSize[1] / 4;
    double volume = 0;
    btVector3 moment(0, 0, 0);
    for (const ContactPoint& point : patch.points) {
      volume += quarter * point.depth;
      moment +=
          (point.on_b + point.normal * (point.depth / 2) - slab.centre) * btScalar(quarter * point.depth);
    }
    EXPECT_NEAR(volume, slab.volume_sum, 1e-4 * slab.volume_sum);
    EXPECT_LT(moment.distance(slab.moment), 2e-3 * kSize[0] * slab.volume_sum) << steep;
  }
}

}  // namespace
}  // namespace innersphere::test
