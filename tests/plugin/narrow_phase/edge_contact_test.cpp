// A cube that stands on an edge or a corner touches there and nowhere else, and is pushed along the normal of
// the face below it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

class EdgeContact : public testing::TestWithParam<std::tuple<std::string, double>> {
 protected:
  void addGround() {
    const std::string& ground = std::get<0>(GetParam());
    if (ground == "packing") {
      world.add(makeShape(latticeBox({3, 3, 1}, 12)), 0, btVector3(0, 0, btScalar(-0.5)));
    } else if (ground == "box") {
      world.add(std::make_shared<btBoxShape>(btVector3(2, 2, 1)), 0, btVector3(0, 0, -1));
    } else {
      world.addFloor();
    }
  }

  /// Contacts of a cube whose lowest point is at `depth` below the ground.
  std::vector<btManifoldPoint> contactsOfCube(const btQuaternion& turn, double depth) {
    const btMatrix3x3 axes(turn);
    const double reach = 0.5 * (std::fabs(axes[2][0]) + std::fabs(axes[2][1]) + std::fabs(axes[2][2]));
    addGround();
    world.add(makeShape(latticeBox({1, 1, 1}, 8)), 1, btVector3(0, 0, btScalar(reach - depth)), turn);
    world.world.performDiscreteCollisionDetection();
    return world.contactsOfLast();
  }

  TestWorld world;
};

TEST_P(EdgeContact, OfATiltedCube) {
  const double tilt = std::get<1>(GetParam());
  const auto points = contactsOfCube(btQuaternion(btVector3(1, 0, 0), btScalar(tilt)), 0.002);
  double left = 1, right = -1;
  for (const btManifoldPoint& point : points) {
    EXPECT_GT(point.m_normalWorldOnB.z(), 0.99999);
    EXPECT_GT(point.getDistance(), -0.0021);
    if (point.getDistance() > -0.0019) continue;
    left = std::min(left, double(point.getPositionWorldOnB().x()));
    right = std::max(right, double(point.getPositionWorldOnB().x()));
  }
  EXPECT_NEAR(left, -0.5, 1e-3);
  EXPECT_NEAR(right, 0.5, 1e-3);
}

TEST_P(EdgeContact, OfACubeOnACorner) {
  const btQuaternion turn = btQuaternion(btVector3(1, 0, 0), btScalar(std::get<1>(GetParam()))) *
                            btQuaternion(btVector3(0, 1, 0), btScalar(0.1));
  const auto points = contactsOfCube(turn, 0.002);
  ASSERT_GE(points.size(), 1u);
  const btMatrix3x3 axes(turn);
  const btVector3 corner(btScalar(axes[2][0] > 0 ? -0.5 : 0.5), btScalar(axes[2][1] > 0 ? -0.5 : 0.5),
                         btScalar(axes[2][2] > 0 ? -0.5 : 0.5));
  const btVector3 lowest = axes * corner;
  EXPECT_NEAR(points[0].getDistance(), -0.002, 1e-4);
  EXPECT_NEAR(points[0].getPositionWorldOnB().x(), lowest.x(), 1e-3);
  EXPECT_NEAR(points[0].getPositionWorldOnB().y(), lowest.y(), 1e-3);
  EXPECT_GT(points[0].m_normalWorldOnB.z(), 0.99999);
}

INSTANTIATE_TEST_SUITE_P(On, EdgeContact,
                         testing::Combine(testing::Values("plane", "box", "packing"),
                                          testing::Values(0.05, 0.2, 0.7)),
                         [](const auto& info) {
                           const int tilt = static_cast<int>(std::lround(1000 * std::get<1>(info.param)));
                           return std::get<0>(info.param) + "_tilted_" + std::to_string(tilt) + "_mrad";
                         });

/// Its corner is above a face, however near to where that ends.
TEST(EdgeContactOnABlock, OfACubeOnACornerCloseToTheRim) {
  const btQuaternion turn =
      btQuaternion(btVector3(1, 0, 0), btScalar(0.2)) * btQuaternion(btVector3(0, 1, 0), btScalar(0.1));
  const btMatrix3x3 axes(turn);
  btVector3 corner;
  for (int k = 0; k < 3; ++k) corner[k] = btScalar(axes[2][k] > 0 ? -0.5 : 0.5);
  const btVector3 lowest = axes * corner;
  for (const double to_rim : {0.003, 0.006, 0.012, 0.025, 0.05}) {
    TestWorld world;
    world.add(makeShape(latticeBox({3, 3, 1}, 12)), 0, btVector3(0, 0, btScalar(-0.5)));
    const btVector3 place(btScalar(1.5 - to_rim), btScalar(0.2), btScalar(-0.002));
    world.add(makeShape(latticeBox({1, 1, 1}, 8)), 1, place - lowest, turn);
    world.world.performDiscreteCollisionDetection();
    const auto points = world.contactsOfLast();
    ASSERT_GE(points.size(), 1u) << to_rim;
    EXPECT_NEAR(points[0].getPositionWorldOnB().distance(place), 0, 3e-3) << to_rim;
    EXPECT_NEAR(points[0].getDistance(), -0.002, 1e-5) << to_rim;
    EXPECT_GT(std::fabs(points[0].m_normalWorldOnB.z()), 0.99999) << to_rim;
  }
}

}  // namespace
}  // namespace innersphere::test
