// Spheres that contain a solid: that they do, how far they reach out of it, and that none takes them for a
// packing.
#include "innersphere/cover_solid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <random>

#include "../file_scratch.hpp"
#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/packing_file.hpp"
#include "innersphere/solids.hpp"

namespace innersphere::test {
namespace {

Packing packed(const Solid& solid, std::size_t spheres) {
  PackOptions options;
  options.spheres = spheres;
  options.order = SphereOrder::coverage;
  options.overlap_errors = false;
  return pack(solid, options);
}

Vec3d centreOf(const Covering& covering, const Sphere& s) {
  return covering.origin + Vec3d{s.x, s.y, s.z};
}

bool holds(const Covering& covering, const Sphere& s, const Vec3d& p) {
  return norm(p - centreOf(covering, s)) <= double{s.radius};
}

/// A triangle lies in a sphere if its corners do. What lies in no single one is cut into four.
bool holdsTriangle(const Covering& covering, const Vec3d& a, const Vec3d& b, const Vec3d& c, int depth) {
  for (const Sphere& s : covering.spheres) {
    if (holds(covering, s, a) && holds(covering, s, b) && holds(covering, s, c)) return true;
  }
  if (depth == 0) return false;
  const Vec3d ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
  return holdsTriangle(covering, a, ab, ca, depth - 1) && holdsTriangle(covering, ab, b, bc, depth - 1) &&
         holdsTriangle(covering, ca, bc, c, depth - 1) && holdsTriangle(covering, ab, bc, ca, depth - 1);
}

class Covers : public ::testing::TestWithParam<std::pair<std::string, std::size_t>> {};

TEST_P(Covers, HoldsAllTrianglesAndAllOfTheInside) {
  const auto& [name, spheres] = GetParam();
  const auto solid = makeNamedSolid(name);
  const Covering covering = coverSolid(*solid, packed(*solid, spheres));
  EXPECT_EQ(covering.spheres.size(), spheres);
  const Mesh mesh = solid->surface();
  for (const auto& t : mesh.triangles) {
    ASSERT_TRUE(holdsTriangle(covering, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], 16));
  }
  std::mt19937_64 random(7);
  const Bounds box = solid->bounds();
  int inside = 0;
  for (int i = 0; i < 100000; ++i) {
    Vec3d p;
    for (int k = 0; k < 3; ++k) p[k] = std::uniform_real_distribution(box.min[k], box.max[k])(random);
    if (!solid->contains(p)) continue;
    ++inside;
    ASSERT_TRUE(std::any_of(covering.spheres.begin(), covering.spheres.end(),
                            [&](const Sphere& s) { return holds(covering, s, p); }));
  }
  EXPECT_GT(inside, 1000);
}

INSTANTIATE_TEST_SUITE_P(CoverSolid, Covers,
                         ::testing::Values(std::pair{"box", 1}, std::pair{"box", 64}, std::pair{"gear", 32},
                                           std::pair{"knot", 64}, std::pair{"tray", 200}),
                         [](const auto& param) {
                           return param.param.first + "_" + std::to_string(param.param.second);
                         });

/// Counts how often it is asked whether a point is inside.
class CountedSolid : public Solid {
 public:
  explicit CountedSolid(std::unique_ptr<Solid> solid) : solid_(std::move(solid)) {}
  ClosestPoint closestPoint(const Vec3d& p, double cutoff) const override {
    return solid_->closestPoint(p, cutoff);
  }
  bool contains(const Vec3d& p) const override {
    ++asked;
    return solid_->contains(p);
  }
  Bounds bounds() const override { return solid_->bounds(); }
  MassProperties massProperties() const override { return solid_->massProperties(); }
  Mesh surface() const override { return solid_->surface(); }
  std::string name() const override { return solid_->name(); }

  mutable std::atomic<std::size_t> asked = 0;

 private:
  std::unique_ptr<Solid> solid_;
};

// The lattice of points around a needle grows with the square of its slenderness, what is near it does not.
TEST(CoverSolid, LooksAtWhatIsNearANeedle) {
  constexpr double kThickness = 1.0 / 256;
  const CountedSolid needle(makeBox({kThickness, kThickness, 1}));
  const Packing packing = packed(needle, 8);
  needle.asked = 0;
  const Covering covering = coverSolid(needle, packing);
  EXPECT_LT(needle.asked, 1000000u);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> part(-0.5, 0.5);
  for (int i = 0; i < 10000; ++i) {
    const Vec3d p{kThickness * part(random), kThickness * part(random), part(random)};
    ASSERT_TRUE(std::any_of(covering.spheres.begin(), covering.spheres.end(),
                            [&](const Sphere& s) { return holds(covering, s, p); }));
  }
}

/// How far a point is outside of the unit cube around the origin.
double outside(const Vec3d& p) {
  double squared = 0;
  for (double x : p) squared += std::pow(std::max(0.0, std::abs(x) - 0.5), 2);
  return std::sqrt(squared);
}

TEST(CoverSolid, StatesItsOverhang) {
  const auto box = makeBox({1, 1, 1});
  const Covering covering = coverSolid(*box, packed(*box, 64));
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  double sum = 0, area = 0, most = 0;
  for (const Sphere& s : covering.spheres) {
    for (int i = 0; i < 3000; ++i) {
      const Vec3d way{normal(random), normal(random), normal(random)};
      const Vec3d p = centreOf(covering, s) + double{s.radius} / norm(way) * way;
      const auto inOther = [&](const Sphere& other) { return &other != &s && holds(covering, other, p); };
      if (std::any_of(covering.spheres.begin(), covering.spheres.end(), inOther)) continue;
      const double weight = double{s.radius} * s.radius;
      sum += weight * outside(p);
      area += weight;
      most = std::max(most, outside(p));
    }
  }
  EXPECT_NEAR(covering.overhang_mean, sum / area, 0.02 * sum / area);
  EXPECT_NEAR(covering.overhang_max, most, 0.03 * most);
  // Spheres of a lattice of 4 x 4 x 4 reach out by (sqrt(3) - 1) / 8.
  EXPECT_LT(covering.overhang_mean, 0.75 * (std::sqrt(3.0) - 1) / 8);
  EXPECT_LT(covering.overhang_max, 1.3 * (std::sqrt(3.0) - 1) / 8);
}

TEST(CoverSolid, IsTheSameForAnyNumberOfThreads) {
  const auto solid = makeNamedSolid("gear");
  const Packing packing = packed(*solid, 32);
  CoverOptions options;
  options.threads = 1;
  const Covering one = coverSolid(*solid, packing, options);
  options.threads = 3;
  const Covering three = coverSolid(*solid, packing, options);
  for (std::size_t i = 0; i < one.spheres.size(); ++i) {
    const Sphere &a = one.spheres[i], &b = three.spheres[i];
    EXPECT_TRUE(a.x == b.x && a.y == b.y && a.z == b.z && a.radius == b.radius);
  }
  EXPECT_EQ(one.overhang_mean, three.overhang_mean);
}

TEST(CoverSolid, TakesTheSurfaceOfAPacking) {
  Packing packing = packed(*makeNamedSolid("lbracket"), 20);
  const Covering covering = coverSurface(packing);
  for (const auto& t : packing.surface.triangles) {
    const auto at = [&](int k) {
      const auto& v = packing.surface.vertices[t[k]];
      return packing.origin + Vec3d{v[0], v[1], v[2]};
    };
    ASSERT_TRUE(holdsTriangle(covering, at(0), at(1), at(2), 16));
  }
  packing.surface = {};
  try {
    coverSurface(packing);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::empty_input);
  }
}

TEST(CoverSolid, IsNotTakenForAPacking) {
  const Scratch scratch;
  const auto box = makeBox({1, 1, 1});
  const std::string path = scratch.path("box.json");
  writeCovering(coverSolid(*box, packed(*box, 10)), path);
  try {
    readPacking(path);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_format);
    EXPECT_NE(std::string(error.what()).find("cover"), std::string::npos);
  }
  EXPECT_THROW(writeCovering(coverSolid(*box, packed(*box, 10)), scratch.path("box.cbor")), Error);
}

TEST(CoverSolid, NamesBadOptions) {
  const auto box = makeBox({1, 1, 1});
  const Packing packing = packed(*box, 4);
  CoverOptions options;
  options.resolution = 0;
  EXPECT_THROW(coverSolid(*box, packing, options), Error);
  EXPECT_THROW(coverSolid(*box, packing, {}, [](const char*, double) { return false; }), Error);
}

}  // namespace
}  // namespace innersphere::test
