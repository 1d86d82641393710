// A cube that lies on the upper edge, or the upper corner, of something touches it there, and is pushed along
// the normal of its own face.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bullet_cube.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

constexpr double kDepth = 0.002;  // [m]

class EdgeBelow : public testing::TestWithParam<std::tuple<std::string, double>> {
 protected:
  /// Contacts of a cube of 2 m with a cube of 1 m whose highest point is kDepth inside of it.
  std::vector<btManifoldPoint> contactsOver(const btQuaternion& turn) {
    const btMatrix3x3 axes(turn);
    const double reach = 0.5 * (std::fabs(axes[2][0]) + std::fabs(axes[2][1]) + std::fabs(axes[2][2]));
    world.add(block_.shape, 0, btVector3(0, 0, btScalar(-reach)), turn);
    world.add(makeShape(latticeBox({2, 2, 2}, 16)), 1, btVector3(btScalar(0.1), 0, btScalar(1 - kDepth)));
    world.world.performDiscreteCollisionDetection();
    return world.contactsOfLast();
  }

  const BulletCube block_{std::get<0>(GetParam())};
  TestWorld world;
};

TEST_P(EdgeBelow, BearsAlongItsLength) {
  const double tilt = std::get<1>(GetParam());
  const auto points = contactsOver(btQuaternion(btVector3(1, 0, 0), btScalar(tilt)));
  const double edge = 0.5 * (std::cos(tilt) - std::sin(tilt));
  double left = 1, right = -1;
  for (const btManifoldPoint& point : points) {
    EXPECT_GT(point.m_normalWorldOnB.z(), 0.99999);
    EXPECT_GT(point.getDistance(), -1.01 * kDepth);
    if (point.getDistance() > -0.99 * kDepth) continue;
    EXPECT_NEAR(point.getPositionWorldOnB().y(), edge, 0.005);
    left = std::min(left, double(point.getPositionWorldOnB().x()));
    right = std::max(right, double(point.getPositionWorldOnB().x()));
  }
  EXPECT_GT(right - left, 0.8);
}

TEST_P(EdgeBelow, BearsAtItsCorner) {
  const btQuaternion turn = btQuaternion(btVector3(1, 0, 0), btScalar(std::get<1>(GetParam()))) *
                            btQuaternion(btVector3(0, 1, 0), btScalar(0.5));
  const auto points = contactsOver(turn);
  const btMatrix3x3 axes(turn);
  const auto side = [&](int i) { return btScalar(axes[2][i] > 0 ? 0.5 : -0.5); };
  const btVector3 highest = axes * btVector3(side(0), side(1), side(2));
  ASSERT_GE(points.size(), 1u);
  EXPECT_NEAR(points[0].getDistance(), -kDepth, 1e-5);
  EXPECT_GT(points[0].m_normalWorldOnB.z(), 0.99999);
  EXPECT_NEAR(points[0].getPositionWorldOnB().x(), highest.x(), 1e-4);
  EXPECT_NEAR(points[0].getPositionWorldOnB().y(), highest.y(), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Of, EdgeBelow,
                         testing::Combine(testing::Values("packing", "box", "hull", "mesh"),
                                          testing::Values(0.05, 0.2, 0.7)),
                         [](const auto& info) {
                           const int tilt = static_cast<int>(std::lround(1000 * std::get<1>(info.param)));
                           return std::get<0>(info.param) + "_tilted_" + std::to_string(tilt) + "_mrad";
                         });

}  // namespace
}  // namespace innersphere::test
