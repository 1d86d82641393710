// The packer's claims about what does not fit, tried by random search.
#include <gtest/gtest.h>

#include "analytic_solids.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/solids.hpp"
#include "mesh_shapes.hpp"
#include "packer_oracles.hpp"

namespace innersphere::test {
namespace {

template <class T>
class PackerCertificate : public testing::Test {};
using Solids = testing::Types<Cube, TestTorus, BittenCube>;
TYPED_TEST_SUITE(PackerCertificate, Solids);

TYPED_TEST(PackerCertificate, NothingLargerFits) {
  const TypeParam solid;
  for (double delta : {0.01, 0.1, 0.5}) {
    PackOptions options;
    options.spheres = 400;
    options.overlap_errors = false;
    options.delta = delta;
    const Packing packing = pack(solid, options);
    EXPECT_LE(packing.certificate.delta, delta);
    EXPECT_GE(packing.certificate.largest_missing_radius, packing.spheres.back().radius / (1 + delta));
    EXPECT_LE(largestRoom(solid, packing, packing.spheres.size(), 100000),
              packing.certificate.largest_missing_radius);
  }
}

TYPED_TEST(PackerCertificate, EveryPrefixIsGreedy) {
  const TypeParam solid;
  PackOptions options;
  options.spheres = 200;
  options.overlap_errors = false;
  const Packing packing = pack(solid, options);
  for (std::size_t count : {1, 2, 5, 20, 70, 199}) {
    EXPECT_LE(largestRoom(solid, packing, count, 40000),
              packing.spheres[count].radius * (1 + packing.certificate.delta))
        << count;
  }
}

// A wall of one thickness: its last round has room for ten times as many spheres as are wanted, and is not
// searched whole.
TEST(PackerCertificate, AWallOfOneThicknessIsFilledAllOver) {
  const auto plate = makeBox({1, 1, 0.008});
  PackOptions options;
  options.spheres = 1500;
  options.overlap_errors = false;
  options.threads = 1;
  const Packing packing = pack(*plate, options);
  EXPECT_LE(packing.certificate.delta, options.delta);
  EXPECT_LE(worstOverlap(packing), 0);
  int in_part[4][4] = {};
  for (const Sphere& s : packing.spheres)
    ++in_part[static_cast<int>(4 * (s.x + 0.5f))][static_cast<int>(4 * (s.y + 0.5f))];
  for (const auto& row : in_part) {
    for (const int count : row) EXPECT_NEAR(count, 1500 / 16, 60);
  }
  options.threads = 3;
  EXPECT_TRUE(sameBytes(packing, pack(*plate, options)));
}

// Cells much larger than a plate is thick are bounded by both of its faces at once. Whatever way it lies, its
// middle keeps room for spheres of half its thickness, and for no larger ones.
TEST(PackerCertificate, APlateInAnyPosition) {
  constexpr double kHalf = 0.002;
  const Mesh plate = boxMesh({-0.5, -0.4, -kHalf}, {0.5, 0.4, kHalf});
  for (int turn = 0; turn < 4; ++turn) {
    const double a = 0.3 * turn, b = 0.5 * turn;
    Mesh turned = plate;
    for (Vec3d& v : turned.vertices) {
      v = {v[0], std::cos(a) * v[1] - std::sin(a) * v[2], std::sin(a) * v[1] + std::cos(a) * v[2]};
      v = {std::cos(b) * v[0] - std::sin(b) * v[1], std::sin(b) * v[0] + std::cos(b) * v[1], v[2]};
    }
    PackOptions options;
    options.spheres = 300;
    options.overlap_errors = false;
    const auto solid = makeSolid(turned, "plate");
    const Packing packing = pack(*solid, options);
    ASSERT_EQ(packing.spheres.size(), 300u);
    EXPECT_LE(worstOverlap(packing), 0);
    EXPECT_GE(packing.certificate.largest_missing_radius, kHalf * (1 - 1e-9));
    EXPECT_LE(packing.certificate.largest_missing_radius, kHalf * (1 + options.delta));
    EXPECT_GE(packing.spheres.back().radius, kHalf / (1 + options.delta));
  }
}

// The search is not blind: the largest sphere of an empty cube is known, and so is the next one.
TEST(PackerCertificate, TheFirstSpheresOfACube) {
  const Cube cube;
  PackOptions options;
  options.spheres = 9;
  options.overlap_errors = false;
  const Packing packing = pack(cube, options);
  EXPECT_NEAR(largestRoom(cube, packing, 0, 40000), 0.5, 1e-3);
  EXPECT_NEAR(packing.spheres[0].radius, 0.5, 1e-6);
  const double corner = 0.5 * (std::sqrt(3.0) - 1) / (std::sqrt(3.0) + 1);
  EXPECT_NEAR(largestRoom(cube, packing, 1, 40000), corner, 1e-3);
  for (std::size_t i = 1; i < 9; ++i) EXPECT_NEAR(packing.spheres[i].radius, corner, 1e-5);
}

}  // namespace
}  // namespace innersphere::test
