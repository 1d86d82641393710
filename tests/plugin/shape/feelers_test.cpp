// Feelers lie inside of the solid, touch its surface, and reach all of it.
#include "shape/feelers.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "shape/packed_model.hpp"
#include "test_packings.hpp"

namespace innersphere::test {
namespace {

/// A packing of one sphere in a box, and feelers for the rest of it.
struct Felt {
  explicit Felt(const Vec3d& box)
      : size(box),
        diagonal(std::hypot(box[0], box[1], box[2])),
        packing(latticeBox(box, 1)),
        surface(packing.surface),
        feelers(placeFeelers(packing, 1, btScalar(diagonal), surface, FeelerPlaces::all)) {}

  double gapAt(const btVector3& place) const {
    const auto gap = [&](const Sphere& s) { return double(place.distance({s.x, s.y, s.z})) - s.radius; };
    double least = gap(packing.spheres[0]);
    for (const Sphere& ball : feelers.balls) least = std::min(least, gap(ball));
    return least;
  }

  const Vec3d size;
  const double diagonal;
  const Packing packing;
  const SurfaceQueries surface;
  const Feelers feelers;
};

class BoxFeelers : public testing::TestWithParam<Vec3d> {};

TEST_P(BoxFeelers, LieInsideAndTouchTheirTriangle) {
  const Felt box(GetParam());
  ASSERT_EQ(box.feelers.triangles.size(), box.feelers.balls.size());
  for (std::size_t i = 0; i < box.feelers.balls.size(); ++i) {
    const Sphere& ball = box.feelers.balls[i];
    const double at[] = {std::fabs(ball.x), std::fabs(ball.y), std::fabs(ball.z)};
    double nearest = 1e9, touched = 1e9;
    for (std::size_t k = 0; k < 3; ++k) nearest = std::min(nearest, box.size[k] / 2 - at[k]);
    const Surface& surface = box.packing.surface;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& t = surface.triangles[box.feelers.triangles[i]];
      const float side = surface.vertices[t[0]][k];
      const bool flat = side == surface.vertices[t[1]][k] && side == surface.vertices[t[2]][k];
      const double centre[] = {ball.x, ball.y, ball.z};
      if (flat) touched = std::min(touched, std::fabs(side - centre[k]));
    }
    // In a corner the smallest ball reaches out a little.
    const double tolerance = 1e-3 * box.diagonal;
    EXPECT_GT(nearest, 0) << i;
    EXPECT_GT(nearest, ball.radius - tolerance) << i;
    EXPECT_NEAR(touched, ball.radius, tolerance) << i;
  }
}

TEST_P(BoxFeelers, ReachAllOfTheSurface) {
  const Felt box(GetParam());
  EXPECT_LE(box.feelers.inset, 0.0101 * box.diagonal);
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  for (int i = 0; i < 3000; ++i) {
    btVector3 place;
    for (int k = 0; k < 3; ++k) place[k] = btScalar(uniform(rng) * box.size[std::size_t(k)]);
    place[i % 3] = btScalar((i % 2 - 0.5) * box.size[std::size_t(i % 3)]);
    // Between places looked at it may be further by as much as these are apart.
    EXPECT_LT(box.gapAt(place), 0.02 * box.diagonal) << i;
  }
  for (const auto& corner : box.packing.surface.vertices)
    EXPECT_LE(box.gapAt({corner[0], corner[1], corner[2]}), 0.0101 * box.diagonal);
}

INSTANTIATE_TEST_SUITE_P(Of, BoxFeelers,
                         testing::Values(Vec3d{1, 1, 1}, Vec3d{1, 0.8, 0.01}, Vec3d{3, 0.1, 0.1}));

TEST(PlaceFeelers, FillsAPlate) {
  // The largest balls that touch the middle of a plate are as thick as the plate.
  const Felt plate({1, 1, 0.01});
  int thick = 0;
  for (const Sphere& ball : plate.feelers.balls) {
    if (std::max(std::fabs(ball.x), std::fabs(ball.y)) > 0.49) continue;
    EXPECT_NEAR(ball.radius, 0.005, 1e-5);
    EXPECT_NEAR(ball.z, 0, 1e-5);
    ++thick;
  }
  EXPECT_GT(thick, 200);
}

TEST(PlaceFeelers, PlacesNoneWhereSpheresAreNearEverywhere) {
  const Packing box = latticeBox({1, 1, 1}, 4);
  const SurfaceQueries surface(box.surface);
  const Feelers feelers = placeFeelers(box, 64, btScalar(0.017), surface, FeelerPlaces::all);  // 1 % of sqrt(3) m
  EXPECT_TRUE(feelers.balls.empty());
  EXPECT_EQ(feelers.inset, btScalar(0.017));
}

/// How many feelers searches among packings need beside the spheres.
std::size_t searchFeelersOf(const Packing& packing) {
  const auto model =
      PackedModel::of(std::make_shared<CollisionModel>(std::make_shared<const Packing>(packing)));
  return model->prefix(packing.spheres.size()).searchFeelers().balls.size();
}

TEST(SearchFeelers, AreThoseOfSolidsThinnerThanTheirGaps) {
  EXPECT_GT(searchFeelersOf(latticeBox({1, 1, 0.01}, 1)), 200U);
  EXPECT_EQ(searchFeelersOf(latticeBox({1, 1, 1}, 1)), 0U) << "gaps in the corners";
  EXPECT_EQ(searchFeelersOf(latticeBox({4, 4, 1}, 16)), 0U) << "small spheres, far apart";
}

}  // namespace
}  // namespace innersphere::test
