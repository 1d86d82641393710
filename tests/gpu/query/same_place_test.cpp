// Bodies that lie upon each other: volume-true spheres of one body overlap each other, so that all lenses
// together are more than there is.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "conformance.hpp"

namespace innersphere::test {
namespace {

constexpr double kVolume = 0.5;  ///< of the solid, for which its spheres in the same place find more

class SamePlaceConformance : public Conformance {
 protected:
  SamePlaceConformance() {
    const auto packing = makePacking(lattice(8, 0.0625), true);
    packing->solid.volume = kVolume;
    model = std::make_shared<CollisionModel>(packing);
    Random random(3);
    query.a = query.b = model.get();
    query.placement_a = query.placement_b = randomPlacement(random, 3, 1.25);
  }

  /// What a query finds has this volume, and all the rest of the oracle's.
  void expect(double volume, Estimator estimator = Estimator::volume_true) {
    QueryContext context = makeContext(1);
    const Oracle oracle = bruteForce(query, estimator);
    Overlap found = context.overlap(query, {Want::wrench, estimator});
    EXPECT_NEAR(found.volume, volume, 1e-9 * volume);
    EXPECT_EQ(context.overlap(query, {Want::volume, estimator}).volume, found.volume);
    QueryResult result;
    context.run(&query, 1, {Want::contacts, estimator}, result);
    EXPECT_TRUE(sameBits(result.overlaps.at(0), found));
    Poses poses;
    const Placement& at = query.placement_b;
    std::array<double, 16> matrix{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) matrix[4 * i + j] = at.rotation[3 * i + j];
      matrix[4 * i + 3] = at.translation[i];
    }
    matrix[15] = 1;
    poses.matrices = matrix.data();
    poses.count = 1;
    Overlap swept;
    context.sweep(query, poses, {Want::wrench, estimator}, &swept);
    EXPECT_TRUE(sameBits(swept, found));
    context.sweep(query, poses, {Want::volume, estimator}, &swept);
    EXPECT_EQ(swept.volume, found.volume);
    EXPECT_EQ(swept.centroid, found.centroid);
    found.volume = static_cast<double>(oracle.volume);
    EXPECT_EQ(differenceInSums(oracle, found), "");
  }

  double lenses(Estimator estimator = Estimator::volume_true) const {
    return static_cast<double>(bruteForce(query, estimator).volume);
  }

  std::shared_ptr<CollisionModel> model;
  PairQuery query;
};

TEST_P(SamePlaceConformance, VolumesAreThoseOfTheSmallerSolid) {
  const double whole = kVolume * std::pow(1.25, 3);
  ASSERT_GT(lenses(), 1.1 * whole);
  expect(whole);
  query.placement_b.translation = query.placement_b.translation + Vec3d{1e-3, -1e-3, 0};
  expect(whole);
  query.placement_b.scale = 1;
  ASSERT_GT(lenses(), 1.01 * kVolume);
  expect(kVolume);
  std::swap(query.placement_a, query.placement_b);
  expect(kVolume);
  query.prefix_a = 64;  // whose radii stand for all of the solid, too
  expect(std::min(kVolume, lenses()));
}

TEST_P(SamePlaceConformance, SumsOfLessAreLeftAlone) {
  query.placement_b.translation = query.placement_b.translation + Vec3d{0.9, 0, 0};
  ASSERT_LT(lenses(), kVolume);
  ASSERT_GT(lenses(), 0.1);
  expect(lenses());
}

TEST_P(SamePlaceConformance, SpheresThatDoNotStandForTheSolidAreSummed) {
  query.placement_b.translation = query.placement_b.translation + Vec3d{1e-3, -1e-3, 0};
  query.margin = 0.1;  // A is larger than its solid, B is not
  expect(kVolume * std::pow(1.25, 3));
  query.margin = 0;
  ASSERT_LT(lenses(Estimator::raw), lenses());
  expect(lenses(Estimator::raw), Estimator::raw);
  const auto packing = std::make_shared<Packing>(model->packing());
  packing->solid.volume = 0;  // not known
  const CollisionModel unknown(packing);
  query.a = query.b = &unknown;
  expect(lenses());
}

// A body that was changed has another volume, which nobody told.
TEST_P(SamePlaceConformance, MovedSpheresAreSummed) {
  QueryContext context = makeContext(1);
  const double before = context.overlap(query, {Want::volume, Estimator::volume_true}).volume;
  Spheres spheres = model->packing().spheres;
  const double all = lenses();
  model->update(spheres.data(), spheres.size());
  const double after = context.overlap(query, {Want::volume, Estimator::volume_true}).volume;
  EXPECT_LT(before, 0.95 * after);
  EXPECT_NEAR(after, all, 1e-9 * all);
}

INNERSPHERE_FOR_EACH_BACKEND(SamePlaceConformance);

}  // namespace
}  // namespace innersphere::test
