// Spheres inside, disjoint, sorted, dense: judged by the checker and by brute force.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "analytic_solids.hpp"
#include "innersphere/check.hpp"
#include "innersphere/error.hpp"
#include "innersphere/packer.hpp"
#include "packer_oracles.hpp"

namespace innersphere::test {
namespace {

Packing packed(const Solid& solid, std::size_t spheres) {
  PackOptions options;
  options.spheres = spheres;
  options.overlap_errors = false;
  return pack(solid, options);
}

void expectValid(const Packing& packing, const Solid& solid) {
  const CheckReport report = check(packing, &solid);
  EXPECT_TRUE(report.valid()) << solid.name() << ": overlap " << report.worst_overlap << " of "
                              << report.overlap_i << " and " << report.overlap_j << ", protrusion "
                              << report.worst_protrusion << " of " << report.protruding;
  EXPECT_LE(worstOverlap(packing), 0) << solid.name();
  EXPECT_NEAR(report.density, packing.quality.density, 1e-9);
  EXPECT_NO_THROW(validate(packing));
}

template <class T>
class PackerValidity : public testing::Test {};
using Solids = testing::Types<Cube, TestBall, TestTorus, BittenCube>;
TYPED_TEST_SUITE(PackerValidity, Solids);

TYPED_TEST(PackerValidity, SpheresAreInsideAndDisjoint) {
  const TypeParam solid;
  expectValid(packed(solid, 700), solid);
}

TYPED_TEST(PackerValidity, FarFromTheOrigin) {
  const TypeParam solid(1, {1000, -1000, 1000});
  expectValid(packed(solid, 300), solid);
}

TYPED_TEST(PackerValidity, Tiny) {
  const TypeParam solid(1e-3, {0, 0, 0.5});
  expectValid(packed(solid, 300), solid);
}

// Formulas of the surfaces, in long double and without Solid.
TEST(PackerInside, Cube) {
  for (const Sphere& s : packed(Cube(), 500).spheres) {
    for (long double x : {s.x, s.y, s.z}) EXPECT_LE(std::abs(x) + s.radius, 0.5L);
  }
}

TEST(PackerInside, Torus) {
  for (const Sphere& s : packed(TestTorus(), 500).spheres) {
    const Real ring = std::hypot(Real{s.x}, Real{s.y}) - 1;
    EXPECT_LE(std::hypot(ring, Real{s.z}) + s.radius, 0.4L);
  }
}

TEST(PackerInside, CubeWithoutABall) {
  const Packing packing = packed(BittenCube(), 500);
  for (const Sphere& s : packing.spheres) {
    for (long double x : {s.x, s.y, s.z}) EXPECT_LE(std::abs(x) + s.radius, 0.5L);
    EXPECT_GE(std::hypot(Real{s.x} - 0.5L, Real{s.y} - 0.5L, Real{s.z} - 0.5L), 0.4L + s.radius);
  }
}

TEST(PackerDensity, UnitCube) {
  EXPECT_GE(packed(Cube(), 1000).quality.density, 0.8335);
}

TEST(PackerDensity, BallIsFullAfterOneSphere) {
  const Packing packing = packed(TestBall(2, {1, 2, 3}), 1000);
  ASSERT_EQ(packing.spheres.size(), 1u);
  EXPECT_NEAR(packing.spheres[0].radius, 2, 1e-6);
  EXPECT_NEAR(packing.spheres[0].y, 2, 1e-6);
  EXPECT_NEAR(packing.quality.density, 1, 1e-6);
  EXPECT_LT(packing.certificate.largest_missing_radius, 0.02);
}

TEST(PackerDensity, EveryPrefixIsDenserThanTheOneBefore) {
  const Packing packing = packed(TestTorus(), 300);
  for (std::size_t i = 1; i < packing.spheres.size(); ++i) {
    EXPECT_LE(packing.spheres[i].radius, packing.spheres[i - 1].radius);
  }
}

/// A cube that gives a wrong answer somewhere.
class BrokenCube : public Cube {
 public:
  std::string name() const override { return "broken cube"; }

 protected:
  Vec3d nearest(const Vec3d& p) const override {
    if (p[0] > 0.3) return {NAN, 0, 0};
    return Cube::nearest(p);
  }
};

TEST(PackerInput, DistanceThatIsNotANumber) {
  try {
    packed(BrokenCube(), 100);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::not_finite);
  }
}

}  // namespace
}  // namespace innersphere::test
