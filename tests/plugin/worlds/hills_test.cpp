// Tops of hills. Two rings that lie on each other cross twice: both crossings are contacts of one direction,
// each with a deepest point of its own, wherever the spheres of the packings are.
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

// A ring hangs on a cylinder along y, and swings in a plane that both are symmetric about. A place beside its
// top that is as deep but for rounding, with a normal that leans, would turn it: friction does not hold it.
TEST(HillTops, NormalsOfARingOnACylinderDoNotLean) {
  constexpr double kPeg = 0.05, kLarge = 0.5, kDeep = 5e-6;
  const auto large = makeTorusShape(kLarge, kTube, 500);
  const auto peg = std::make_shared<btCylinderShape>(btVector3(kPeg, 0.3, kPeg));
  const btQuaternion about_y(btVector3(1, 0, 0), SIMD_HALF_PI);
  const double length = kLarge - kTube - kPeg + kDeep;
  for (int i = -50; i <= 50; ++i) {
    const double angle = 0.007 * i;
    TestWorld world;
    world.add(peg, 0, btVector3(0, 0, 0));
    world.add(large, 1, btVector3(btScalar(length * std::sin(angle)), 0, btScalar(-length * std::cos(angle))),
              about_y);
    world.world.performDiscreteCollisionDetection();
    const auto contacts = world.contactsOfLast();
    ASSERT_FALSE(contacts.empty()) << angle;
    const btVector3& normal = contacts.front().m_normalWorldOnB;
    EXPECT_NEAR(normal.y(), 0, 2e-5) << angle;
    EXPECT_NEAR(std::atan2(-double(normal.x()), double(normal.z())), angle, 1e-4) << angle;
  }
}

}  // namespace
}  // namespace innersphere::test
