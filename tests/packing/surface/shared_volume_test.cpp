#include "surface/shared_volume.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

namespace innersphere {
namespace {

constexpr double kHeight = 20;
constexpr std::uint32_t kSides = 48;

/// An upright prism about the axis z, with sides of two long triangles each.
Surface prism() {
  Surface surface;
  surface.vertices = {{0, 0, 0}, {0, 0, kHeight}};
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    const auto x = static_cast<float>(std::cos(angle)), y = static_cast<float>(std::sin(angle));
    surface.vertices.push_back({x, y, 0});
    surface.vertices.push_back({x, y, kHeight});
    const std::uint32_t a = 2 + 2 * i, b = 2 + 2 * ((i + 1) % kSides);
    surface.triangles.insert(surface.triangles.end(),
                             {{a, b, b + 1}, {a, b + 1, a + 1}, {0, b, a}, {1, a + 1, b + 1}});
  }
  return surface;
}

double crossSection() {
  return 0.5 * kSides * std::sin(2 * std::numbers::pi / kSides);
}

/// Turned about the axis x, then moved.
Similarity moved(double angle, const Vec3d& by) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{{1, 0, 0, 0, c, -s, 0, s, c}}, by};
}

TEST(SharedVolume, OfLongTrianglesThatLieInOnePlane) {
  const SurfaceTree tree(prism());
  for (const double shift : {0.5, 7.25, 19.0}) {
    const SharedSums sums = sharedVolume({tree, moved(0, {})}, {tree, moved(0, {0, 0, shift})});
    EXPECT_NEAR(sums.volume, crossSection() * (kHeight - shift), 1e-6 * crossSection() * kHeight);
    EXPECT_NEAR(sums.area.z, -crossSection(), 1e-6 * crossSection());
  }
}

TEST(SharedVolume, OfCrossedPrismsIsThatOfTheirCircles) {
  // Steinmetz: 16/3 for circles; prisms are inside of these.
  const SurfaceTree tree(prism());
  const SharedSums sums = sharedVolume({tree, moved(0, {})},
                                       {tree, moved(std::numbers::pi / 2, {0.0, kHeight / 2, kHeight / 2})});
  EXPECT_NEAR(sums.volume, 16.0 / 3, 0.01 * 16 / 3);
  EXPECT_LT(sums.volume, 16.0 / 3);
}

TEST(SharedVolume, HasTheSameBitsWithAvx512) {
  if (!hasAvx512()) GTEST_SKIP() << "This processor has no AVX-512.";
  const SurfaceTree tree(prism());
  int overlapping = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3d by{0.013 * i - 1.3, 0.4 - 0.003 * i, 1 - 0.011 * i};
    const PlacedSurface a{tree, moved(0.031 * i, {})}, b{tree, moved(1.1 - 0.027 * i, by)};
    const SharedSums any = sharedVolume(a, b, false), wide = sharedVolume(a, b, true);
    EXPECT_EQ(std::memcmp(&any, &wide, sizeof any), 0)
        << "pose " << i << ": " << any.volume << " and " << wide.volume;
    if (any.volume > 0) ++overlapping;
  }
  EXPECT_GT(overlapping, 100);
}

}  // namespace
}  // namespace innersphere
