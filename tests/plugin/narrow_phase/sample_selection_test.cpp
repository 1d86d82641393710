// Which spheres of a patch are probed.
#include "narrow_phase/sample_selection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace innersphere::test {
namespace {

/// Spheres whose protrusion is what a test says.
class Spheres : public ContactSpheres {
 public:
  std::uint64_t id(std::size_t index) const override { return 1000 + index; }
  Protrusion protrusion(std::size_t index, const btVector3&) const override { return protrusions[index]; }

  std::vector<Protrusion> protrusions;
};

/// Contacts strewn over a square of 2 m in the plane z = 0, with areas of one size that face up.
class Patch {
 public:
  explicit Patch(std::size_t count) {
    std::mt19937 rng(7);
    std::uniform_real_distribution<float> place(-1, 1);
    for (std::size_t i = 0; i < count; ++i) {
      SphereContact contact;
      contact.sphere = std::uint32_t(i);
      contact.volume = 1e-3F;
      contact.centroid = {place(rng), place(rng), 0};
      contact.area = {0, 0, 0.01F};
      contacts.push_back(contact);
      indices.push_back(i);
      spheres.protrusions.push_back({true, 0});
    }
    moments = patchMoments(contacts, indices, btMatrix3x3::getIdentity());
  }
  Samples select() const {
    Samples samples;
    SelectionScratch scratch;
    appendSamples({contacts, indices, moments, old_ids, spheres}, scratch, samples);
    return samples;
  }

  std::vector<SphereContact> contacts;
  std::vector<std::size_t> indices;
  std::vector<std::uint64_t> old_ids;
  Spheres spheres;
  PatchMoments moments;
};

bool holds(const Samples& samples, std::size_t i) {
  return std::find(samples.indices.begin(), samples.indices.end(), i) != samples.indices.end();
}

TEST(AppendSamples, TakesAllOfAFew) {
  const Patch patch(20);
  const Samples samples = patch.select();
  EXPECT_EQ(samples.indices, patch.indices);
  ASSERT_EQ(samples.patches.size(), 1u);
  EXPECT_EQ(samples.patches[0].end, 20u);
  EXPECT_NEAR(samples.patches[0].area, 0.2, 1e-6);
  EXPECT_NEAR(samples.patches[0].normal.z(), 1, 1e-6);
}

TEST(AppendSamples, TakesSomeOfMany) {
  const Patch patch(500);
  const Samples samples = patch.select();
  const std::set<std::size_t> different(samples.indices.begin(), samples.indices.end());
  EXPECT_EQ(different.size(), samples.indices.size());
  EXPECT_LE(samples.indices.size(), 8u + 16 + 6 + 6);
  EXPECT_GE(samples.indices.size(), 8u);
  EXPECT_LT(*different.rbegin(), 500u);
}

TEST(AppendSamples, TakesThoseThatSpanThePatch) {
  const Patch patch(500);
  const Samples samples = patch.select();
  for (int k = 0; k < 8; ++k) {
    const double angle = k * M_PI / 4;
    std::size_t furthest = 0;
    double most = -1e9;
    for (std::size_t i = 0; i < patch.contacts.size(); ++i) {
      const double along =
          patch.contacts[i].centroid[0] * std::cos(angle) + patch.contacts[i].centroid[1] * std::sin(angle);
      if (along > most) {
        most = along;
        furthest = i;
      }
    }
    EXPECT_TRUE(holds(samples, furthest)) << k;
  }
}

TEST(AppendSamples, TakesThoseThatStandOutOfEachSolid) {
  Patch patch(500);
  patch.spheres.protrusions[123] = {true, btScalar(0.1)};
  for (std::size_t i = 300; i < 500; ++i) patch.spheres.protrusions[i] = {false, -1};
  patch.spheres.protrusions[321] = {false, btScalar(-0.9)};
  const Samples samples = patch.select();
  EXPECT_TRUE(holds(samples, 123));
  EXPECT_TRUE(holds(samples, 321));
}

TEST(AppendSamples, TakesThoseThatFaceTheOtherMost) {
  Patch patch(500);
  for (std::size_t i = 40; i < 46; ++i) patch.contacts[i].area[2] = 0.02F;
  const Samples samples = patch.select();
  for (std::size_t i = 40; i < 46; ++i) EXPECT_TRUE(holds(samples, i));
}

TEST(AppendSamples, KeepsThoseOfTheStepBefore) {
  Patch patch(500);
  patch.old_ids = {1077, 1222, 1431, 9999};
  const Samples samples = patch.select();
  for (const std::size_t i : {77u, 222u, 431u}) EXPECT_TRUE(holds(samples, i));
}

TEST(AppendSamples, AppendsPatchAfterPatch) {
  const Patch first(10), second(15);
  Samples samples;
  SelectionScratch scratch;
  appendSamples({first.contacts, first.indices, first.moments, first.old_ids, first.spheres}, scratch,
                samples);
  appendSamples({second.contacts, second.indices, second.moments, second.old_ids, second.spheres}, scratch,
                samples);
  ASSERT_EQ(samples.patches.size(), 2u);
  EXPECT_EQ(samples.patches[0].end, 10u);
  EXPECT_EQ(samples.patches[1].end, 25u);
}

TEST(DropShallow, KeepsWhatIsAlmostAsDeepAsTheDeepest) {
  // 10 to 0.5 mm apart.
  std::vector<btScalar> depths;
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < 11; ++i) {
    depths.push_back(btScalar(1e-3) * (btScalar(i) - btScalar(10.5)));
    all.push_back(i);
  }
  std::vector<std::size_t> kept = all;
  dropShallow(depths, btScalar(1.6e-3), 0, 0, kept);  // 3.2 mm less deep than 0.5 mm apart is not
  EXPECT_EQ(kept, (std::vector<std::size_t>{7, 8, 9, 10}));
  kept = all;
  dropShallow(depths, btScalar(1.6e-3), btScalar(2e-3), btScalar(1e-3), kept);
  EXPECT_EQ(kept, (std::vector<std::size_t>{4, 5, 6, 7, 8, 9, 10}));
}

TEST(DropShallow, KeepsAllThatOverlap) {
  // However deep one is: what is in the other body has to come out.
  const std::vector<btScalar> depths{btScalar(-0.01), btScalar(-0.001), btScalar(0.001), btScalar(0.3)};
  std::vector<std::size_t> kept{0, 1, 2, 3};
  dropShallow(depths, btScalar(1e-3), 0, 0, kept);
  EXPECT_EQ(kept, (std::vector<std::size_t>{2, 3}));
}

TEST(Turn, TurnsNormalsAndLines) {
  Samples samples;
  samples.patches.push_back({btVector3(1, 0, 0), 1, 1, 1});
  samples.indices = {0};
  samples.lines.push_back({btVector3(0, 1, 0), 3, 4});
  turn(btMatrix3x3(btQuaternion(btVector3(0, 0, 1), SIMD_HALF_PI)), samples);
  EXPECT_NEAR(samples.patches[0].normal.distance(btVector3(0, 1, 0)), 0, 1e-6);
  EXPECT_NEAR(samples.lines[0].direction.distance(btVector3(-1, 0, 0)), 0, 1e-6);
  EXPECT_EQ(samples.lines[0].triangle_a, 3u);
}

TEST(DropUnprobed, LeavesThoseWithALine) {
  Samples samples;
  samples.indices = {10, 11, 12, 13, 14};
  samples.lines.resize(5);
  for (const std::size_t i : {1u, 2u, 4u}) samples.lines[i].direction.setValue(0, 0, 1);
  samples.patches.push_back({btVector3(0, 0, 1), 1, 1, 1});
  samples.patches.push_back({btVector3(0, 0, 1), 1, 1, 4});
  samples.patches.push_back({btVector3(0, 0, 1), 1, 1, 5});
  dropUnprobed(samples);
  EXPECT_EQ(samples.indices, (std::vector<std::size_t>{11, 12, 14}));
  EXPECT_EQ(samples.lines.size(), 3u);
  EXPECT_EQ(samples.patches[0].end, 0u);
  EXPECT_EQ(samples.patches[1].end, 2u);
  EXPECT_EQ(samples.patches[2].end, 3u);
}

}  // namespace
}  // namespace innersphere::test
