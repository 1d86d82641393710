// Meshes of the scenes bound the volumes that they should.
#include <gtest/gtest.h>

#include <cmath>

#include "innersphere/mesh.hpp"
#include "scenes/shapes.hpp"

namespace innersphere::test {
namespace {

// Area of a regular polygon with n corners on a circle.
double polygonArea(double radius, int n) {
  return 0.5 * n * radius * radius * std::sin(2 * M_PI / n);
}

TEST(Shapes, PrismOverARingHasTheVolumeBetweenItsPolygons) {
  const demo::Outline ring = demo::ringOutline(demo::circlePoints(2, 12), demo::circlePoints(1, 12));
  MeshReport report;
  const auto solid = makeSolid(demo::prism(ring, 0.5), "ring", {}, &report);
  EXPECT_NEAR(solid->massProperties().volume, 0.5 * (polygonArea(2, 12) - polygonArea(1, 12)), 1e-9);
  EXPECT_FALSE(report.inside_out);
  EXPECT_EQ(report.components, 1u);
  EXPECT_FALSE(solid->contains({0, 0, 0.25}));
  EXPECT_TRUE(solid->contains({1.5, 0, 0.25}));
}

TEST(Shapes, LatheTurnsAProfile) {
  // A double cone: (0, -1) to (1, 0) to (0, 2).
  MeshReport report;
  const auto solid = makeSolid(demo::lathe({{0, -1}, {1, 0}, {0, 2}}, 16), "cone", {}, &report);
  EXPECT_NEAR(solid->massProperties().volume, polygonArea(1, 16) * 3 / 3, 1e-9);
  EXPECT_FALSE(report.inside_out);
}

}  // namespace
}  // namespace innersphere::test
