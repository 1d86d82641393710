// Meshes of the scenes bound the volumes that they should.
#include <gtest/gtest.h>

#include <cmath>

#include "innersphere/mesh.hpp"
#include "scenes/scans.hpp"
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

TEST(Shapes, GridIsWhatIsFilled) {
  MeshReport report;
  const auto solid = makeSolid(demo::prism(demo::gridOutline({0, 1, 3, 4}, {0, 1, 3}, {"###", "#.#"}), 2),
                               "arch", {}, &report);
  EXPECT_NEAR(solid->massProperties().volume, 2 * (4 * 2 + 2 * 1), 1e-9);
  EXPECT_FALSE(report.inside_out);
  EXPECT_EQ(report.components, 1u);
  EXPECT_FALSE(solid->contains({2, 0.5, 1})) << "the gap, in the row that is named last";
  EXPECT_TRUE(solid->contains({2, 2, 1}));
}

TEST(Shapes, TubesAreRoundAndClosed) {
  const auto expectVolume = [](const std::vector<demo::Point2>& path, bool closed, double volume) {
    MeshReport report;
    const auto solid =
        makeSolid(demo::tube(path, std::vector<double>(path.size(), 0.1), 32, closed), "tube", {}, &report);
    EXPECT_NEAR(solid->massProperties().volume, volume, 1e-9);
    EXPECT_FALSE(report.inside_out);
  };
  expectVolume({{0, 0}, {1, 0}, {3, 0}}, false, 3 * polygonArea(0.1, 32));
  MeshReport report;
  const auto ring = makeSolid(demo::tube(demo::circlePoints(1, 400), std::vector<double>(400, 0.1), 32, true),
                              "ring", {}, &report);
  EXPECT_NEAR(ring->massProperties().volume, 2 * M_PI * polygonArea(0.1, 32), 1e-4);
  EXPECT_FALSE(report.inside_out);
}

TEST(Shapes, LumpOfOneRadiusIsABall) {
  MeshReport report;
  const auto ball = makeSolid(demo::lump([](const Vec3d&) { return 2; }, 5), "ball", {}, &report);
  EXPECT_NEAR(ball->massProperties().volume, 32 * M_PI / 3, 0.1);
  EXPECT_FALSE(report.inside_out);
  EXPECT_EQ(report.triangles, 8u << 10);
}

TEST(Shapes, ScansBoundVolumes) {
  for (const auto& solid : demo::scans()) {
    const MassProperties mass = solid->massProperties();
    EXPECT_GT(mass.volume, 0) << solid->name();
  }
}

}  // namespace
}  // namespace innersphere::test
