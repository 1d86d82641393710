// Queries within a budget: as long as it allows, no longer, and with the error that the packings state.
#include "innersphere/bounded_query.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "conformance.hpp"
#include "innersphere/error.hpp"

namespace innersphere::test {
namespace {

/// What a pair errs whose logarithms of found over true have half the variance of each body's.
double together(double a, double b) {
  const double x = std::log(1 - a), y = std::log(1 - b);
  return 1 - std::exp(-std::sqrt(x * x / 2 + y * y / 2));
}

class BoundedQueryConformance : public Conformance {
 protected:
  BoundedQueryConformance() {
    const auto packing = makePacking(randomSpheres(1000, 0.2, 30, 1));
    packing->solid.volume = 7;
    OverlapErrors& errors = packing->overlap_errors;
    errors.poses = 100;
    errors.shallowest = 0.01;
    errors.prefixes = {{64, estimate(0.5), estimate(0.25)}, {512, estimate(0.4), estimate(0.05)}};
    a = std::make_shared<CollisionModel>(packing);
    b = makeModel(randomSpheres(300, 0.3, 20, 2));
    query.a = a.get();
    query.b = a.get();
    query.placement_b = at({0.2, 0.1, 0});
  }

  /// A mean that falls as 1 / (100 times the depth), from a hundredth on, and twice that as bound.
  static OverlapErrors::Estimate estimate(double at_a_hundredth) {
    OverlapErrors::Estimate result;
    for (const double depth : {0.01, 0.03, 0.08, 0.2, 0.5}) {
      const double mean = at_a_hundredth * 0.01 / depth;
      result.copies.push_back({depth, {mean, 2 * mean}});
    }
    result.thickest = 1e9;
    result.planes = {{0.1, {0.01, 0.05}}};
    return result;
  }

  std::shared_ptr<CollisionModel> a, b;
  PairQuery query;
};

TEST_P(BoundedQueryConformance, SpheresChooseTheLength) {
  QueryContext context = makeContext(1);
  BoundedQuery bounded(context);
  query.b = b.get();
  const auto all_a = static_cast<std::uint32_t>(a->packing().spheres.size());
  const auto all_b = static_cast<std::uint32_t>(b->packing().spheres.size());
  ASSERT_GT(all_a, 512u);
  const std::array<std::uint32_t, 5> steps{64, 128, 256, 512, all_a};
  const auto expectStep = [&](std::uint64_t budget, std::size_t step) {
    const BoundedOverlap result = bounded.overlap(query, {0, budget});
    PairQuery same = query;
    same.prefix_a = steps[step];
    same.prefix_b = std::min(steps[step], all_b);
    EXPECT_EQ(result.prefix_a, same.prefix_a) << budget;
    EXPECT_EQ(result.prefix_b, same.prefix_b) << budget;
    EXPECT_TRUE(sameBits(result.overlap, context.overlap(same)));
  };
  expectStep(0, 4);
  expectStep(1, 0);
  for (std::size_t step = 0; step < steps.size(); ++step) {
    const std::uint64_t needed = std::uint64_t{steps[step]} + std::min(steps[step], all_b);
    expectStep(needed, step);
    expectStep(needed - 1, step == 0 ? 0 : step - 1);
  }
  query.prefix_a = 100;
  EXPECT_EQ(bounded.overlap(query, {}).prefix_a, 100u);
}

TEST_P(BoundedQueryConformance, TimeChoosesTheLength) {
  QueryContext context = makeContext(1);
  BoundedQuery bounded(context);
  EXPECT_EQ(bounded.overlap(query, {1000, 0}).prefix_a, 64u);  // nothing is known yet
  bounded.warmUp(query);
  EXPECT_EQ(bounded.overlap(query, {1000, 0}).prefix_a, a->packing().spheres.size());
  EXPECT_EQ(bounded.overlap(query, {1e-12, 0}).prefix_a, 64u);
  EXPECT_EQ(bounded.overlap(query, {1000, 300}).prefix_a, 128u);
}

TEST_P(BoundedQueryConformance, ErrorIsThatOfThePackings) {
  QueryContext context = makeContext(1);
  BoundedQuery bounded(context);
  const auto error = [&](std::uint64_t spheres, Estimator estimator) {
    return bounded.overlap(query, {0, spheres}, {Want::wrench, estimator});
  };
  for (const std::uint64_t spheres : {128u, 1024u}) {
    const BoundedOverlap result = error(spheres, Estimator::raw);
    const double volume = result.overlap.volume,
                 depth = volume / std::hypot(norm(result.overlap.area), std::pow(volume, 2.0 / 3)) /
                         std::cbrt(7.0),
                 mean = (spheres == 128 ? 0.5 : 0.4) * 0.01 / depth;
    ASSERT_GT(depth, 0.01);
    ASSERT_LT(depth, 0.5);
    EXPECT_NEAR(result.error, mean, 1e-9 * mean);
    EXPECT_NEAR(result.error_bound, 2 * mean, 1e-9 * mean);
  }
  EXPECT_LT(error(1024, Estimator::volume_true).error, error(1024, Estimator::raw).error);
  // Depth is relative to the scaled solid; both bodies count; beyond the last depth its errors hold.
  query.placement_b.scale = 3;
  double stiffness = 1;
  const auto errorOf = [&](double volume, double area, Estimator estimator = Estimator::raw) {
    Overlap found;
    found.volume = volume;
    found.area = {0, 0.6 * area, -0.8 * area};
    found.stiffness = stiffness;
    return expectedError(query, estimator, found);
  };
  // 0.1 deep for B, which is large and for which it is a thin layer; 0.3 for A.
  const double volume = 0.1 * 7 * 27, depth = 0.1 * std::cbrt(7.0) * 3;
  const double area = std::sqrt(std::pow(volume / depth, 2) - std::pow(volume, 4.0 / 3));
  EXPECT_NEAR(errorOf(volume, area).mean, together(0.04, 0.04 / 3), 1e-9);
  EXPECT_NEAR(errorOf(volume, area).bound, together(0.08, 0.08 / 3), 1e-9);
  EXPECT_NEAR(errorOf(volume, 0.01 * area).mean, together(0.4 * 0.01 / 0.5, 0.4 * 0.01 / std::cbrt(0.1)),
              2e-5);
  EXPECT_NEAR(errorOf(1000, 0.1).mean, 0.4 * 0.01 / 0.5, 1e-9);
  EXPECT_NEAR(errorOf(1000, 1e9).mean, 0.4, 1e-9);
  EXPECT_TRUE(std::isnan(errorOf(0.1 * 7 / 11, 1).mean));                    // too shallow for A
  EXPECT_TRUE(std::isnan(errorOf(0.1 * 7, 1).mean));                         // too shallow for B
  EXPECT_TRUE(std::isnan(errorOf(volume, 0).bound));                         // as Want::volume leaves it
  EXPECT_TRUE(std::isnan(errorOf(volume, area, Estimator::surface).bound));  // there are no triangles
  // Lenses that are thicker than those of copies are foretold by planes, for each body by itself.
  stiffness = volume / (1e9 * std::cbrt(7.0)) / 2;
  EXPECT_NEAR(errorOf(volume, area).mean, together(0.04, 0.01), 1e-9);  // not for B, which is larger
  stiffness = 0;
  EXPECT_NEAR(errorOf(volume, area).mean, 0.01, 1e-9);
  EXPECT_NEAR(errorOf(volume, area).bound, together(0.05, 0.08 / 3), 1e-9);
  EXPECT_NEAR(errorOf(1000, 0.1).mean, 0.4 * 0.01 / 0.5, 1e-9);  // copies are better there
  query.placement_b = at({50, 0, 0});
  EXPECT_TRUE(std::isnan(error(0, Estimator::raw).error));
  query.placement_b = at({0.2, 0.1, 0});
  query.b = b.get();  // states nothing
  EXPECT_TRUE(std::isnan(error(0, Estimator::raw).error));
}

// The volume is taken relative to each scaled solid.
TEST_P(BoundedQueryConformance, ErrorFallsWithTheVolume) {
  const auto packing = makePacking(randomSpheres(64, 0.2, 30, 1));
  packing->solid.volume = 8;
  packing->overlap_errors.prefixes = {{64, {{{0.1, {0.2, 0.4}, 0.01, 0.5}}, 1e9, {}, {}}, {}}};
  const CollisionModel model(packing);
  query.a = query.b = &model;
  Overlap found;
  found.volume = 0.04 * 8;
  found.stiffness = found.energy = 1;
  EXPECT_NEAR(expectedError(query, Estimator::raw, found).mean, 0.1, 1e-9);
  query.placement_b.scale = 2;
  EXPECT_NEAR(expectedError(query, Estimator::raw, found).mean, together(0.1, 0.2 * std::sqrt(2)), 1e-9);
  found.volume = 1e-9 * 8;
  EXPECT_EQ(expectedError(query, Estimator::raw, found).mean, 1);
}

TEST_P(BoundedQueryConformance, BadInput) {
  QueryContext context = makeContext(1);
  BoundedQuery bounded(context);
  for (const double seconds : {-1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(bounded.overlap(query, {seconds, 0}), Error);
  query.a = nullptr;
  EXPECT_THROW(bounded.overlap(query, {}), Error);
}

INNERSPHERE_FOR_EACH_BACKEND(BoundedQueryConformance);

}  // namespace
}  // namespace innersphere::test
