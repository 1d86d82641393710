// Two rings that lie on each other cross twice: both crossings are contacts of one direction, each with a
// deepest point of its own, wherever the spheres of the packings are.
#include <gtest/gtest.h>

#include <cmath>

#include "named_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kRing = 0.4, kTube = 0.1;

class Hills : public testing::TestWithParam<std::tuple<double, double>> {
 protected:
  static void SetUpTestSuite() { ring = makeTorusShape(kRing, kTube, 500); }
  static void TearDownTestSuite() { ring.reset(); }
  static std::shared_ptr<PackingShape> ring;
};
std::shared_ptr<PackingShape> Hills::ring;

TEST_P(Hills, EachHasItsTop) {
  // The upper ring is tilted, so that one crossing touches and the other does not: their lines are as far
  // apart as the planes of the rings there.
  const auto [shift, turn] = GetParam();
  const double tilt = 1e-3, depth = 1e-4;
  const double half = std::sqrt(kRing * kRing - shift * shift / 4);
  TestWorld world;
  const btVector3 up(0, 0, 1);
  world.add(ring, 0, btVector3(0, 0, 0), btQuaternion(up, btScalar(turn)));
  const double height = 2 * kTube - depth + half * std::sin(tilt);
  world.add(ring, 1, btVector3(btScalar(shift), 0, btScalar(height)),
            btQuaternion(btVector3(1, 0, 0), btScalar(tilt)) * btQuaternion(up, btScalar(2 * turn)));
  world.world.performDiscreteCollisionDetection();
  const auto contacts = world.contactsOfLast();
  for (const int side : {-1, 1}) {
    const double gap = height + side * half * std::sin(tilt) - 2 * kTube;
    double nearest = 1, distance = 0;
    for (const btManifoldPoint& point : contacts) {
      const btVector3 at = point.getPositionWorldOnB();
      const double away = std::hypot(double(at.x()) - shift / 2, double(at.y()) - side * half);
      if (away < nearest) {
        nearest = away;
        distance = double(point.getDistance());
      }
    }
    EXPECT_LT(nearest, 0.005) << side;
    EXPECT_NEAR(distance, gap, 3e-4) << side;
  }
}

INSTANTIATE_TEST_SUITE_P(Turned, Hills,
                         testing::Combine(testing::Values(0.2, 0.3, 0.5, 0.6, 0.65, 0.7),
                                          testing::Values(0.0, 0.3, 0.9, 1.7, 2.6)));

}  // namespace
}  // namespace innersphere::test
