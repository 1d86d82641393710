// A round solid over the edge of a block touches the block, not the plane that its face would go on in.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bullet_cube.hpp"
#include "named_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kRing = 0.4, kTube = 0.1;

/// Signed distance from a cube of 1 m.
double distanceOf(const btVector3& p) {
  double outside2 = 0, inside = -1;
  for (int i = 0; i < 3; ++i) {
    const double beyond = std::fabs(double(p[i])) - 0.5;
    outside2 += std::pow(std::max(beyond, 0.0), 2);
    inside = std::max(inside, beyond);
  }
  return outside2 > 0 ? std::sqrt(outside2) : inside;
}

class BeyondEdge : public testing::TestWithParam<std::string> {
 protected:
  static void SetUpTestSuite() { ring = makeTorusShape(kRing, kTube, 500); }
  static void TearDownTestSuite() { ring.reset(); }

  static std::shared_ptr<PackingShape> ring;
};
std::shared_ptr<PackingShape> BeyondEdge::ring;

/// The lowest place of a ring goes from over the face to beyond the edge.
TEST_P(BeyondEdge, NothingBears) {
  const BulletCube block(GetParam());
  int contacts = 0;
  for (const double tilt : {0.02, 0.1, 0.3, 0.6}) {
    for (const double turn : {0.0, 0.7, 1.6, 2.5}) {
      for (double beyond = -0.06; beyond < 0.09; beyond += 0.01) {
        TestWorld world;
        world.add(block.shape, 0, btVector3(0, 0, 0));
        // The ring leans about the x axis, so that its lowest place lies at -y of its centre.
        const double lowest_y = -kRing * std::cos(tilt), lowest_z = -kRing * std::sin(tilt) - kTube;
        world.add(ring, 1, btVector3(0, btScalar(0.5 + beyond - lowest_y), btScalar(0.5 - 0.001 - lowest_z)),
                  btQuaternion(btVector3(1, 0, 0), btScalar(tilt)) *
                      btQuaternion(btVector3(0, 0, 1), btScalar(turn)));
        world.world.performDiscreteCollisionDetection();
        bool bears = false;
        for (const btManifoldPoint& point : world.contactsOfLast()) {
          if (!(point.getDistance() < 0)) continue;
          bears = true;
          ++contacts;
          EXPECT_LT(std::fabs(distanceOf(point.getPositionWorldOnB())), 0.004)
              << "lowest " << beyond << " beyond the edge, leans by " << tilt << ", turned by " << turn;
        }
        // The tube is round: 1 mm deep at the most, and less than that from the edge on.
        if (std::fabs(beyond - 0.0075) < 0.0125) continue;
        EXPECT_EQ(bears, beyond < 0) << beyond << " " << tilt << " " << turn;
      }
    }
  }
  EXPECT_GT(contacts, 100);
}

INSTANTIATE_TEST_SUITE_P(Blocks, BeyondEdge, testing::Values("box", "hull", "mesh", "packing"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace innersphere::test
