// Enlarged spheres hold all of the surface, so that a search with them misses no place where two surfaces are
// near.
#include "shape/search_spheres.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "innersphere/packer.hpp"
#include "innersphere/query.hpp"
#include "innersphere/solids.hpp"
#include "test_packings.hpp"

namespace innersphere::test {
namespace {

using Point = std::array<double, 3>;

double distanceOf(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

double gapOf(const Point& p, const Sphere& s) {
  return distanceOf(p, {s.x, s.y, s.z}) - double(s.radius);
}

double leastGap(const Point& p, const std::vector<Sphere>& spheres, std::size_t count) {
  double least = 1e9;
  for (std::size_t i = 0; i < count; ++i) least = std::min(least, gapOf(p, spheres[i]));
  return least;
}

/// Places at random on all triangles, on their edges, and their corners.
std::vector<Point> placesOn(const Surface& surface, std::size_t count, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform;
  std::vector<Point> places;
  for (std::size_t n = 0; n < count; ++n) {
    const auto& t = surface.triangles[n % surface.triangles.size()];
    std::array<double, 3> weights{uniform(engine), uniform(engine), n % 5 == 0 ? 0 : uniform(engine)};
    if (n % 7 == 0) weights = {1, 0, 0};
    const double sum = weights[0] + weights[1] + weights[2];
    Point p{};
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        p[axis] += weights[k] / sum * double(surface.vertices[t[k]][axis]);
    }
    places.push_back(p);
  }
  return places;
}

const Packing& packed(const std::string& solid) {
  static std::map<std::string, Packing> known;
  const auto [at, is_new] = known.try_emplace(solid);
  if (is_new) {
    PackOptions options;
    options.spheres = 500;
    options.overlap_errors = false;
    at->second = pack(*makeNamedSolid(solid), options);
  }
  return at->second;
}

struct Enlarged {
  Enlarged(const std::string& solid, std::size_t n) : count(n), packing(packed(solid)) {
    count = std::min(count, packing.spheres.size());
    spheres = searchSpheres(packing.surface,
                            {packing.spheres.begin(), packing.spheres.begin() + std::ptrdiff_t(count)});
    Point min{1e9, 1e9, 1e9}, max{-1e9, -1e9, -1e9};
    for (const auto& v : packing.surface.vertices) {
      for (std::size_t k = 0; k < 3; ++k) {
        min[k] = std::min(min[k], double(v[k]));
        max[k] = std::max(max[k], double(v[k]));
      }
    }
    size = distanceOf(min, max);
  }
  std::size_t count;
  const Packing& packing;
  std::vector<Sphere> spheres;
  double size = 0;
};

/// A solid, and how many of 500 spheres are used.
using Case = std::tuple<std::string, std::size_t>;

class SearchSpheres : public testing::TestWithParam<Case> {};

TEST_P(SearchSpheres, HoldAllOfTheSurface) {
  const Enlarged e(std::get<0>(GetParam()), std::get<1>(GetParam()));
  ASSERT_EQ(e.spheres.size(), e.count);
  for (const Point& p : placesOn(e.packing.surface, 20000, 1))
    EXPECT_LT(leastGap(p, e.spheres, e.count), 1e-6 * e.size);
}

double distanceToEdge(const Point& p, const Point& a, const Point& b) {
  double along = 0, length2 = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    along += (p[k] - a[k]) * (b[k] - a[k]);
    length2 += (b[k] - a[k]) * (b[k] - a[k]);
  }
  const double t = length2 > 0 ? std::clamp(along / length2, 0.0, 1.0) : 0;
  return distanceOf(p, {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])});
}

double distanceToTriangle(const Point& p, const std::array<Point, 3>& v) {
  double least = 1e9;
  for (std::size_t k = 0; k < 3; ++k) least = std::min(least, distanceToEdge(p, v[k], v[(k + 1) % 3]));
  Point u, w, n;
  for (std::size_t k = 0; k < 3; ++k) u[k] = v[1][k] - v[0][k], w[k] = v[2][k] - v[0][k];
  for (std::size_t k = 0; k < 3; ++k)
    n[k] = u[(k + 1) % 3] * w[(k + 2) % 3] - u[(k + 2) % 3] * w[(k + 1) % 3];
  const double n2 = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  if (!(n2 > 0)) return least;
  for (std::size_t k = 0; k < 3; ++k) {  // over the triangle: on the inner side of all edges
    const Point &a = v[k], &b = v[(k + 1) % 3];
    double side = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, l = (i + 2) % 3;
      side += n[i] * ((b[j] - a[j]) * (p[l] - a[l]) - (b[l] - a[l]) * (p[j] - a[j]));
    }
    if (side < 0) return least;
  }
  double height = 0;
  for (std::size_t k = 0; k < 3; ++k) height += n[k] * (p[k] - v[0][k]);
  return std::fabs(height) / std::sqrt(n2);
}

/// Where a place of the one surface is near the other, as all triangles tell, a sphere that holds it is
/// found.
TEST_P(SearchSpheres, FindAllContact) {
  const Enlarged e(std::get<0>(GetParam()), std::get<1>(GetParam()));
  auto only_spheres = std::make_shared<Packing>();
  only_spheres->spheres.assign(e.packing.spheres.begin(),
                               e.packing.spheres.begin() + std::ptrdiff_t(e.count));
  CollisionModel model(only_spheres);
  model.update(e.spheres.data(), e.spheres.size());
  const std::vector<Point> places = placesOn(e.packing.surface, 400, 3);
  const double separation = 0.01 * e.size;
  std::mt19937 engine(4);
  std::normal_distribution<double> normal;
  QueryContext context(QueryContextOptions{Backend::cpu, 1});
  QueryResult result;
  std::size_t near = 0;
  for (int pose = 0; pose < 30; ++pose) {
    PairQuery query;
    query.a = query.b = &model;
    query.margin = separation;
    double q[4], length2 = 0;
    for (double& x : q) x = normal(engine), length2 += x * x;
    const double w = q[0], x = q[1], y = q[2], z = q[3], s = 2 / length2;
    query.placement_b.rotation = {1 - s * (y * y + z * z), s * (x * y - z * w),     s * (x * z + y * w),
                                  s * (x * y + z * w),     1 - s * (x * x + z * z), s * (y * z - x * w),
                                  s * (x * z - y * w),     s * (y * z + x * w),     1 - s * (x * x + y * y)};
    for (double& t : query.placement_b.translation) t = 0.15 * e.size * normal(engine);
    context.run(&query, 1, {Want::contacts, Estimator::raw}, result);
    std::vector<bool> found(e.count, false);
    for (const SphereContact& c : result.contacts_a.items) found[c.sphere] = true;
    std::vector<std::array<Point, 3>> other;
    for (const auto& t : e.packing.surface.triangles) {
      std::array<Point, 3> v{};
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < 3; ++i) {
          v[k][i] = query.placement_b.translation[i];
          for (std::size_t j = 0; j < 3; ++j)
            v[k][i] += query.placement_b.rotation[3 * i + j] * double(e.packing.surface.vertices[t[k]][j]);
        }
      }
      other.push_back(v);
    }
    for (const Point& p : places) {
      const bool is_near = std::any_of(other.begin(), other.end(), [&](const auto& v) {
        return distanceToTriangle(p, v) < 0.999 * separation;
      });
      if (!is_near) continue;
      ++near;
      bool is_found = false;
      for (std::size_t i = 0; i < e.count && !is_found; ++i)
        is_found = found[i] && gapOf(p, e.spheres[i]) < 1e-6 * e.size;
      EXPECT_TRUE(is_found) << "pose " << pose;
    }
  }
  EXPECT_GT(near, 30u);
}

std::string nameOf(const testing::TestParamInfo<Case>& info) {
  return std::get<0>(info.param) + "_" + std::to_string(std::get<1>(info.param));
}

INSTANTIATE_TEST_SUITE_P(Of, SearchSpheres,
                         testing::Values(Case{"chazelle", 500}, Case{"chazelle", 20}, Case{"bowl", 100},
                                         Case{"box", 8}, Case{"gear", 500}, Case{"lbracket", 1}),
                         nameOf);

/// A cube about (x, 0, 0).
void addCube(double x, double half, Surface& surface) {
  const Surface cube = latticeBox({2 * half, 2 * half, 2 * half}, 1).surface;
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (const auto& v : cube.vertices) surface.vertices.push_back({v[0] + float(x), v[1], v[2]});
  for (const auto& t : cube.triangles)
    surface.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

TEST(SearchSpheresOfTwoCubes, AreEnlargedEachToItsOwnCorners) {
  Packing packing;
  packing.spheres = {{0, 0, 0, 0.5f}, {2, 0, 0, 0.1f}, {0, 0, 0, 0.05f}};
  addCube(0, 0.5, packing.surface);
  addCube(2, 0.1, packing.surface);
  const std::vector<Sphere> enlarged =
      searchSpheres(packing.surface, {packing.spheres.begin(), packing.spheres.begin() + 3});
  EXPECT_NEAR(enlarged[0].radius, 0.5 * std::sqrt(3), 1e-5);
  EXPECT_NEAR(enlarged[1].radius, 0.1 * std::sqrt(3), 1e-5);
  EXPECT_EQ(enlarged[2].radius, 0.05f);  // nearest to none
}

TEST(SearchSpheresWithWideGaps, AreAllEnlargedAlike) {
  const Packing packing = latticeBox({4, 4, 1}, 8);
  const std::vector<Sphere> enlarged = searchSpheres(packing.surface, packing.spheres);
  const double r = packing.spheres[0].radius;
  // The corner is as far from the sphere next to it as that is from its cell's: (1/4, 1/4, 1/16).
  for (const Sphere& s : enlarged) EXPECT_NEAR(s.radius, std::hypot(0.25, 0.25, 0.0625), 1e-5);
  EXPECT_GT(std::hypot(0.25, 0.25, 0.0625), 3 * r);
}

/// Far from the origin single precision leaves a surface in steps that are no smaller than a piece.
TEST(SearchSpheresFarAway, EndWhereNumbersAreTooLarge) {
  Packing packing;
  packing.spheres = {{1e7f, 1e7f, 1e7f, 1}, {1e7f + 8, 1e7f, 1e7f, 1}};
  packing.surface.vertices = {{1e7f, 1e7f, 1e7f + 2}, {1e7f + 8, 1e7f, 1e7f + 2}, {1e7f, 1e7f + 1, 1e7f}};
  packing.surface.triangles = {{0, 1, 2}};
  const std::vector<Sphere> enlarged =
      searchSpheres(packing.surface, {packing.spheres.begin(), packing.spheres.begin() + 2});
  for (const auto& v : packing.surface.vertices) EXPECT_LT(leastGap({v[0], v[1], v[2]}, enlarged, 2), 1);
}

}  // namespace
}  // namespace innersphere::test
