// Ball, box, torus and cylinder against their implicit equations and against a fine mesh of themselves.
#include <gtest/gtest.h>

#include <functional>

#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/solids.hpp"
#include "mesh_oracles.hpp"
#include "mesh_shapes.hpp"

namespace innersphere::test {
namespace {

struct Shape {
  const char* name;
  std::function<std::unique_ptr<Solid>()> make;
  std::function<double(const Vec3d&)> field;  ///< zero on the surface, negative inside
  double facets;                              ///< how far the surface's facets are from the solid
};

void PrintTo(const Shape& shape, std::ostream* out) {
  *out << shape.name;
}

const std::vector<Shape>& shapes() {
  static const std::vector<Shape> all{
      {"ball", [] { return makeBall(0.7); },
       [](const Vec3d& p) { return std::hypot(p[0], p[1], p[2]) - 0.7; }, 0.005},
      {"box",
       [] {
         return makeBox({1, 2, 0.5});
       },
       [](const Vec3d& p) {
         return std::max({std::abs(p[0]) - 0.5, std::abs(p[1]) - 1, std::abs(p[2]) - 0.25});
       },
       1e-6},
      {"torus", [] { return makeTorus(1, 0.3); },
       [](const Vec3d& p) { return std::hypot(std::hypot(p[0], p[1]) - 1, p[2]) - 0.3; }, 0.005},
      {"cylinder", [] { return makeCylinder(0.6, 1.5); },
       [](const Vec3d& p) { return std::max(std::hypot(p[0], p[1]) - 0.6, std::abs(p[2]) - 0.75); }, 0.002},
  };
  return all;
}

class SolidsAnalytic : public testing::TestWithParam<Shape> {};

TEST_P(SolidsAnalytic, ClosestPointIsOnTheSurfaceAndNearest) {
  const auto solid = GetParam().make();
  const auto mesh = makeSolid(solid->surface(), "mesh");
  const Bounds box = solid->bounds();
  std::mt19937 random(11);
  for (int trial = 0; trial < 3000; ++trial) {
    Vec3d p = randomPoint(random, box.min, box.max);
    for (double& x : p) x *= trial % 3 == 0 ? 2 : 1;
    if (trial < 3) p = {0, 0, trial * 0.1};  // on the axis, where the direction is undefined
    const ClosestPoint c = solid->closestPoint(p);
    EXPECT_NEAR(GetParam().field(c.point), 0, 1e-14);
    EXPECT_NEAR(std::hypot(c.point[0] - p[0], c.point[1] - p[1], c.point[2] - p[2]), c.distance, 1e-14);
    EXPECT_NEAR(mesh->closestPoint(p).distance, c.distance, GetParam().facets);
    EXPECT_EQ(solid->contains(p), GetParam().field(p) < 0);
    EXPECT_EQ(solid->closestPoint(p, c.distance).distance, c.distance);
    EXPECT_TRUE(c.distance == 0 || std::isinf(solid->closestPoint(p, 0.99 * c.distance).distance));
  }
}

TEST_P(SolidsAnalytic, MassPropertiesMatchAGridSum) {
  const auto solid = GetParam().make();
  const Bounds box = solid->bounds();
  constexpr int n = 100;
  double volume = 0, xx = 0, yy = 0, zz = 0;
  for (int i = 0; i < n * n * n; ++i) {
    const Vec3d p{box.min[0] + (i % n + 0.5) / n * (box.max[0] - box.min[0]),
                  box.min[1] + (i / n % n + 0.5) / n * (box.max[1] - box.min[1]),
                  box.min[2] + (i / n / n + 0.5) / n * (box.max[2] - box.min[2])};
    if (GetParam().field(p) >= 0) continue;
    volume += 1;
    xx += p[0] * p[0];
    yy += p[1] * p[1];
    zz += p[2] * p[2];
  }
  double cell = 1;
  for (int k = 0; k < 3; ++k) cell *= (box.max[k] - box.min[k]) / n;
  const MassProperties mass = solid->massProperties();
  EXPECT_NEAR(volume * cell / mass.volume, 1, 2e-3);
  EXPECT_NEAR((yy + zz) * cell / mass.inertia[0], 1, 4e-3);
  EXPECT_NEAR((zz + xx) * cell / mass.inertia[4], 1, 4e-3);
  EXPECT_NEAR((xx + yy) * cell / mass.inertia[8], 1, 4e-3);
  EXPECT_EQ(mass.inertia[1], 0);
  EXPECT_EQ(mass.centre_of_mass, (Vec3d{0, 0, 0}));
}

TEST_P(SolidsAnalytic, SurfaceIsClosedAndCloseInVolume) {
  const auto solid = GetParam().make();
  const Mesh mesh = solid->surface();
  EXPECT_TRUE(isClosedManifold(mesh));
  EXPECT_NEAR(volumeOf(mesh) / solid->massProperties().volume, 1, 0.01);
}

INSTANTIATE_TEST_SUITE_P(All, SolidsAnalytic, testing::ValuesIn(shapes()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(SolidsAnalytic, RefuseLengthsThatAreNot) {
  EXPECT_THROW(makeBall(0), Error);
  EXPECT_THROW(makeBall(-1), Error);
  EXPECT_THROW(makeBall(std::nan("")), Error);
  EXPECT_THROW(makeBox({1, 0, 1}), Error);
  EXPECT_THROW(makeTorus(0.3, 0.3), Error);
  EXPECT_THROW(makeCylinder(1, INFINITY), Error);
}

TEST(SolidsAnalytic, HashTellsThemApart) {
  std::set<std::string> hashes;
  for (const Shape& shape : shapes()) hashes.insert(shape.make()->hash());
  hashes.insert(makeBall(0.8)->hash());
  hashes.insert(makeTorus(0.9, 0.4)->hash());
  EXPECT_EQ(hashes.size(), shapes().size() + 2);
  EXPECT_EQ(makeBall(0.8)->hash(), makeBall(0.8)->hash());
}

}  // namespace
}  // namespace innersphere::test
