#include "surface/shared_volume.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>
#include <vector>

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

using Polygon = std::vector<Vec3d>;

/// What is left of a polygon on one side of a plane through three points.
Polygon clipped(const Polygon& polygon, const Vec3d& a, const Vec3d& b, const Vec3d& c, double side) {
  const Vec3d normal = side * cross(b - a, c - a);
  Polygon left;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double hp = dot(normal, p - a), hq = dot(normal, q - a);
    if (hp >= 0) left.push_back(p);
    if ((hp < 0) != (hq < 0)) left.push_back(p + hp / (hp - hq) * (q - p));
  }
  return left;
}

/// Sums over the triangles of one solid, as far as they are in the other one. That is made of tetrahedra from
/// one point to each of its triangles, to be added or taken away: each triangle is cut by each of them.
SharedSums enclosedPart(const Surface& own, const Similarity& own_place, const Surface& other,
                        const Similarity& other_place) {
  const auto corners = [](const Surface& surface, const Similarity& place, const auto& triangle) {
    Polygon at;
    for (const std::uint32_t v : triangle) {
      const auto& x = surface.vertices[v];
      at.push_back(place({x[0], x[1], x[2]}));
    }
    return at;
  };
  const Vec3d top{0.137, -0.241, 0.519};
  SharedSums sums;
  for (const auto& t : own.triangles) {
    for (const auto& u : other.triangles) {
      const Polygon base = corners(other, other_place, u);
      const double volume = dot(base[0] - top, cross(base[1] - top, base[2] - top));
      if (volume == 0) continue;
      const double sign = volume > 0 ? 1 : -1;
      Polygon part = clipped(corners(own, own_place, t), base[0], base[2], base[1], sign);
      for (int k = 0; k < 3; ++k) part = clipped(part, top, base[k], base[(k + 1) % 3], sign);
      for (std::size_t k = 2; k < part.size(); ++k) {
        const Vec3d &p = part[0], &q = part[k - 1], &r = part[k], normal = 0.5 * sign * cross(q - p, r - p);
        const double cone = sign * dot(p, cross(q, r)) / 6;
        sums.volume += cone;
        sums.moment = sums.moment + cone / 4 * (p + q + r);
        sums.area = sums.area + normal;
        sums.turning = sums.turning + 1.0 / 3 * cross(p + q + r, normal);
        sums.wetted += sign * norm(normal);
      }
    }
  }
  return sums;
}

void expectBruteForce(const Surface& a, const Similarity& place_a, const Surface& b,
                      const Similarity& place_b) {
  const SurfaceTree tree_a(a), tree_b(b);
  const SharedSums sums = sharedVolume({tree_a, place_a}, {tree_b, place_b});
  const SharedSums of_a = enclosedPart(a, place_a, b, place_b), of_b = enclosedPart(b, place_b, a, place_a);
  constexpr double kTolerance = 1e-9;
  EXPECT_NEAR(sums.volume, of_a.volume + of_b.volume, kTolerance);
  EXPECT_LT(norm(sums.moment - of_a.moment - of_b.moment), kTolerance);
  EXPECT_LT(norm(sums.area - of_b.area), kTolerance);
  EXPECT_LT(norm(sums.turning - of_b.turning), kTolerance);
  EXPECT_NEAR(sums.wetted, of_b.wetted, kTolerance);
}

void append(const Surface& part, Surface& whole, bool inside_out = false) {
  const auto first = static_cast<std::uint32_t>(whole.vertices.size());
  whole.vertices.insert(whole.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (auto t : part.triangles) {
    if (inside_out) std::swap(t[1], t[2]);
    whole.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
}

/// A cube about the origin. The edges of its upper side are halved, on this side alone: there are triangles
/// without an area between it and all others.
Surface cube(float half) {
  Surface surface;
  for (const float z : {-half, half}) {
    for (int i = 0; i < 4; ++i)
      surface.vertices.push_back({i == 1 || i == 2 ? half : -half, i >= 2 ? half : -half, z});
  }
  surface.vertices.insert(
      surface.vertices.end(),
      {{0, -half, half}, {half, 0, half}, {0, half, half}, {-half, 0, half}, {0, 0, half}});
  surface.triangles = {{0, 2, 1}, {0, 3, 2}};
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t next = (i + 1) % 4, a = 4 + i, b = 4 + next, middle = 8 + i;
    surface.triangles.insert(surface.triangles.end(),
                             {{i, next, b}, {i, b, a}, {a, b, middle}, {a, middle, 12}, {middle, b, 12}});
  }
  return surface;
}

TEST(SharedVolume, IsThatOfAllTrianglesCutByAllTetrahedra) {
  const Surface solid = prism();
  for (int i = 0; i < 12; ++i) {
    const Vec3d by{0.31 * i - 1.7, 0.4 - 0.13 * i, 1.3 * i - 8};
    SCOPED_TRACE(i);
    expectBruteForce(solid, moved(0.31 * i, {0.1, 0.2, -0.3}), solid, moved(1.1 - 0.27 * i, by));
  }
}

TEST(SharedVolume, OfPartsHollowsAndTrianglesWithoutArea) {
  // A hollow cube with a smaller one in it, and one beside; parts are cut, enclosed, or neither.
  Surface solid = cube(1);
  append(cube(0.75F), solid, true);
  append(cube(0.5F), solid);
  Surface beside = cube(0.25F);
  for (auto& v : beside.vertices) v[0] += 1.5F;
  append(beside, solid);
  for (int i = 0; i < 24; ++i) {
    SCOPED_TRACE(i);
    const double angle = 0.1 + 0.7 * i;
    // The upper sides of A are exactly flat on the grid, and in the other solid in some poses.
    expectBruteForce(solid, moved(0, {}), solid,
                     moved(angle, {0.17 * i - 1.9, 0.05 * i - 0.4, 1.6 - 0.07 * i}));
    expectBruteForce(solid, moved(angle, {0.2, 0.1, -1.1 - 0.01 * i}), cube(1.25F),
                     moved(0.3, {0.4, 0.1, 0}));
  }
}

}  // namespace
}  // namespace innersphere
