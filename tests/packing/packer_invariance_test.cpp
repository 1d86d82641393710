// What must not change a packing: threads, repetition, size, place.
#include <gtest/gtest.h>

#include "analytic_solids.hpp"
#include "innersphere/error.hpp"
#include "innersphere/packer.hpp"
#include "packer_oracles.hpp"

namespace innersphere::test {
namespace {

Packing packed(const Solid& solid, int threads = 0) {
  PackOptions options;
  options.spheres = 600;
  options.threads = threads;
  return pack(solid, options);
}

TEST(PackerInvariance, ThreadsAndRuns) {
  const TestTorus torus;
  const Cube cube;
  const Packing first_torus = packed(torus, 1), first_cube = packed(cube, 1);
  for (int threads : {1, 2, 8}) {
    EXPECT_TRUE(sameBytes(packed(torus, threads), first_torus)) << threads;
    EXPECT_TRUE(sameBytes(packed(cube, threads), first_cube)) << threads;
  }
}

TEST(PackerInvariance, SizeByAPowerOfTwoIsExact) {
  const Packing one = packed(BittenCube());
  for (double size : {1.0 / 1024, 4096.0}) {
    const Packing other = packed(BittenCube(size));
    ASSERT_EQ(other.spheres.size(), one.spheres.size());
    for (std::size_t i = 0; i < one.spheres.size(); ++i) {
      EXPECT_EQ(other.spheres[i].x, one.spheres[i].x * size);
      EXPECT_EQ(other.spheres[i].radius, one.spheres[i].radius * size);
    }
    EXPECT_EQ(other.quality.density, one.quality.density);
  }
}

// Rounding to single precision differs, so that ties may be decided otherwise; nothing else.
TEST(PackerInvariance, SizeAndPlace) {
  const Packing one = packed(Cube());
  for (const Cube& cube : {Cube(0.001), Cube(37), Cube(1, {10, 20, -30}), Cube(0.01, {1, 1, 1})}) {
    const Packing other = packed(cube);
    const double size = cube.bounds().max[0] - cube.bounds().min[0];
    EXPECT_EQ(other.spheres.size(), one.spheres.size());
    EXPECT_NEAR(other.quality.density, one.quality.density, 0.003);
    EXPECT_NEAR(other.spheres.back().radius / size, one.spheres.back().radius,
                0.03 * one.spheres.back().radius);
  }
}

// Single precision ends somewhere, and the packing says so.
TEST(PackerInvariance, APlaceTooFarFromTheOriginIsNamed) {
  EXPECT_TRUE(packed(Cube(1, {1000, 0, 0})).warnings.empty());
  const Packing far = packed(Cube(1, {1e5, 0, 0}));
  ASSERT_FALSE(far.warnings.empty());
  EXPECT_NE(far.warnings[0].find("origin"), std::string::npos) << far.warnings[0];
  try {
    packed(Cube(1, {1e8, 0, 0}));
    ADD_FAILURE() << "packed where numbers are 8 apart";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::no_sphere_fits);
    EXPECT_NE(std::string(error.what()).find("origin"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace innersphere::test
