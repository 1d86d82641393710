#include "innersphere/patch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "innersphere/error.hpp"
#include "sphere_sets.hpp"

namespace innersphere::test {
namespace {

std::vector<Patch> build(const std::vector<SphereContact>& contacts, const PatchOptions& options = {}) {
  std::vector<Patch> patches;
  buildPatches(contacts.data(), contacts.size(), options, patches);
  return patches;
}

/// n x n contacts on a square in the plane of x and y about `centre`, with area vectors along `direction`.
void addSquare(std::vector<SphereContact>& contacts, int n, double size, const Vec3d& centre,
               const Vec3d& direction) {
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      SphereContact c;
      c.sphere = static_cast<std::uint32_t>(contacts.size());
      c.volume = 1e-3f;
      c.centroid = {static_cast<float>(centre[0] + size * ((i + 0.5) / n - 0.5)),
                    static_cast<float>(centre[1] + size * ((j + 0.5) / n - 0.5)),
                    static_cast<float>(centre[2])};
      for (int k = 0; k < 3; ++k) c.area[k] = static_cast<float>(direction[k] * size * size / (n * n));
      contacts.push_back(c);
    }
  }
}

/// Nothing is lost: volumes and area vectors of the patches sum to those of the contacts.
void expectConserved(const std::vector<SphereContact>& contacts, const std::vector<Patch>& patches) {
  double volume = 0, patch_volume = 0, size = 0;
  Vec3d area{}, patch_area{};
  for (const SphereContact& c : contacts) {
    volume += c.volume;
    for (int k = 0; k < 3; ++k) area[k] += c.area[k], size += std::fabs(c.area[k]);
  }
  for (const Patch& p : patches) {
    patch_volume += p.volume;
    for (int k = 0; k < 3; ++k) patch_area[k] += p.area * p.normal[k];
  }
  EXPECT_NEAR(volume, patch_volume, 1e-9 * volume);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(area[k], patch_area[k], 1e-9 * size);
}

TEST(Patches, OneFlatSquare) {
  std::vector<SphereContact> contacts;
  addSquare(contacts, 20, 2, {5, 6, 7}, {0, 0, 1});
  const auto patches = build(contacts);
  ASSERT_EQ(patches.size(), 1u);
  const Patch& p = patches[0];
  EXPECT_NEAR(p.area, 4, 1e-5);
  EXPECT_NEAR(p.volume, 0.4, 1e-6);
  EXPECT_NEAR(p.depth(), 0.1, 1e-6);
  EXPECT_NEAR(p.normal[2], 1, 1e-12);
  EXPECT_NEAR(p.centroid[0], 5, 1e-5);
  EXPECT_NEAR(p.centroid[2], 7, 1e-5);
  const double variance =
      4.0 / 12 * (1 - 1.0 / 400);  // of a square of side 2, less that of one cell of the 20
  EXPECT_NEAR(p.covariance[0], variance, 1e-5);
  EXPECT_NEAR(p.covariance[4], variance, 1e-5);
  EXPECT_NEAR(p.covariance[8], 0, 1e-6);
  EXPECT_NEAR(p.covariance[1], 0, 1e-6);
}

TEST(Patches, DirectionsApartDoNotMix) {
  std::vector<SphereContact> contacts;
  addSquare(contacts, 10, 1, {0, 0, 0}, {0, 0, 1});
  addSquare(contacts, 10, 0.8, {0, 0, 0.1}, {1, 0, 0});
  const auto patches = build(contacts);
  ASSERT_EQ(patches.size(), 2u);
  EXPECT_NEAR(patches[0].normal[2], 1, 1e-9);  // the larger first
  EXPECT_NEAR(patches[1].normal[0], 1, 1e-9);
  expectConserved(contacts, patches);
}

TEST(Patches, PlacesApartDoNotMix) {
  std::vector<SphereContact> contacts;
  for (double x : {-1.0, 1.0}) {
    for (double y : {-1.0, 1.0}) addSquare(contacts, 5, 0.3, {x, y, 0}, {0, 0, -1});
  }
  const auto patches = build(contacts);
  ASSERT_EQ(patches.size(), 4u);
  for (const Patch& p : patches) {
    EXPECT_NEAR(std::fabs(p.centroid[0]), 1, 1e-5);
    EXPECT_NEAR(std::fabs(p.centroid[1]), 1, 1e-5);
    EXPECT_NEAR(p.area, 0.09, 1e-6);
  }
  expectConserved(contacts, patches);
}

TEST(Patches, TinyOnesMergeIntoTheLikeliestNeighbour) {
  std::vector<SphereContact> contacts;
  addSquare(contacts, 10, 1, {0, 0, 0}, {0, 0, 1});
  addSquare(contacts, 10, 1, {0, 0, 3}, {1, 0, 0});
  addSquare(contacts, 1, 0.1, {0, 0, 3}, {std::sqrt(0.5), std::sqrt(0.5), 0});
  const auto patches = build(contacts);
  ASSERT_EQ(patches.size(), 2u);
  EXPECT_NEAR(patches[0].area + patches[1].area, 2, 0.02);
  expectConserved(contacts, patches);
}

TEST(Patches, NeverMoreThanAskedFor) {
  Random random(1);
  std::vector<SphereContact> contacts;
  for (std::uint32_t i = 0; i < 300; ++i) {
    const Vec3d d = random.direction();
    SphereContact c;
    c.sphere = i;
    c.volume = static_cast<float>(random.uniform());
    for (int k = 0; k < 3; ++k)
      c.centroid[k] = static_cast<float>(d[k]), c.area[k] = static_cast<float>(d[k] * random.uniform(0.5, 1));
    contacts.push_back(c);
  }
  for (std::size_t most : {1u, 2u, 4u, 16u}) {
    PatchOptions options;
    options.max_patches = most;
    const auto patches = build(contacts, options);
    EXPECT_LE(patches.size(), most);
    for (const Patch& p : patches) {
      EXPECT_NEAR(p.normal[0] * p.normal[0] + p.normal[1] * p.normal[1] + p.normal[2] * p.normal[2], 1, 1e-9);
    }
    expectConserved(contacts, patches);
    const auto again = build(contacts, options);
    ASSERT_EQ(again.size(), patches.size());
    EXPECT_EQ(std::memcmp(again.data(), patches.data(), patches.size() * sizeof(Patch)), 0);
  }
}

TEST(Patches, SpheresPushedFromAllSidesOnlyAddVolume) {
  std::vector<SphereContact> contacts;
  addSquare(contacts, 4, 1, {0, 0, 0}, {0, 0, 1});
  addSquare(contacts, 1, 1, {0, 0, -0.5}, {0, 0, 0});
  auto patches = build(contacts);
  ASSERT_EQ(patches.size(), 1u);
  EXPECT_NEAR(patches[0].volume, 17e-3, 1e-8);
  EXPECT_NEAR(patches[0].centroid[2], 0, 1e-9);
  contacts.assign(1, contacts.back());
  EXPECT_TRUE(build(contacts).empty());
}

/// Such areas have no direction. In the same place of one sum they were no group, and volumes had none to go
/// to.
TEST(Patches, InfiniteAreasOnlyAddVolume) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float area : {kInfinity, std::numeric_limits<float>::quiet_NaN()}) {
    std::vector<SphereContact> contacts;
    addSquare(contacts, 2, 1, {0, 0, 0}, {0, 0, 1});
    contacts[0].area = {area, 0, 0};
    contacts[1].area = {-area, 0, 0};
    const auto patches = build(contacts);
    ASSERT_EQ(patches.size(), 1u);
    EXPECT_NEAR(patches[0].normal[2], 1, 1e-6);
    EXPECT_NEAR(patches[0].area, 0.5, 1e-6);
    EXPECT_NEAR(patches[0].volume, 4e-3, 1e-8);
    contacts.resize(2);
    EXPECT_TRUE(build(contacts).empty());
  }
}

TEST(Patches, NothingFromNothing) {
  std::vector<Patch> patches(3);
  buildPatches(nullptr, 0, {}, patches);
  EXPECT_TRUE(patches.empty());
  PatchOptions options;
  options.max_patches = 0;
  EXPECT_THROW(buildPatches(nullptr, 0, options, patches), Error);
}

}  // namespace
}  // namespace innersphere::test
