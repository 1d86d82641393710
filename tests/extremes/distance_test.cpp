// Far from the origin. The query and the contacts work with the difference of two places, so what is left is
// what Bullet's scalars can say of a place: with doubles 1e6 m are as good as the origin; with floats, whose
// step is 6e-8 of the distance, a body of 1 m rests within 0.5 % of its size to 1 km, within 10 % to 100 km,
// and at 1,000 km, where places are 6 cm apart, nothing breaks.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "watched_world.hpp"

namespace innersphere::test {
namespace {

class FarFromTheOrigin : public testing::TestWithParam<std::tuple<double, int>> {};

TEST_P(FarFromTheOrigin, ABoxFallsOnAPackingAndRests) {
  const auto& [distance, axis] = GetParam();
  constexpr double kDt = 1.0 / 240;
  btVector3 away(0, 0, 0);
  away[axis] = btScalar(distance);
  WatchedWorld world;
  const double drop = 0.05;
  world.add(makeShape(latticeBox({3, 3, 2}, 12)), 0, away + btVector3(0, 0, -1));
  const btRigidBody& body =
      world.add(makeShape(latticeBox({1, 1, 1}, 6)), 1000, away + btVector3(0, 0, btScalar(0.5 + drop)));
  world.watch(2, kDt);
  const btVector3 place = body.getWorldTransform().getOrigin() - away;
  EXPECT_TRUE(world.finite());
  const double spacing = distance * double(std::numeric_limits<btScalar>::epsilon());
  const double allowed = 0.005 + 8 * spacing;
  EXPECT_NEAR(place.x(), 0, allowed);
  EXPECT_NEAR(place.y(), 0, allowed);
  EXPECT_NEAR(place.z(), 0.5, allowed);
  EXPECT_LT(world.kineticEnergy(), 1000 * 9.81 * (0.001 * drop + 8 * spacing));
}

INSTANTIATE_TEST_SUITE_P(By, FarFromTheOrigin,
                         testing::Combine(testing::Values(0, 1e2, 1e3, 1e4, 1e5, 1e6), testing::Values(0, 2)),
                         [](const auto& info) {
                           return std::to_string(std::lround(std::get<0>(info.param))) + "_m_along_" +
                                  "xyz"[std::get<1>(info.param)];
                         });

}  // namespace
}  // namespace innersphere::test
