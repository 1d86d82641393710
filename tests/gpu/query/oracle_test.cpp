// Pairs and sums against brute force, for every kind of sphere set.
#include "conformance.hpp"

namespace innersphere::test {
namespace {

class OracleConformance : public Conformance {};

TEST_P(OracleConformance, RandomSetsAtRandomPoses) {
  QueryContext context = makeContext();
  const auto a = makeModel(randomSpheres(300, 0.3, 20, 1), true),
             b = makeModel(randomSpheres(200, 0.25, 50, 2), true);
  Random random(3);
  std::size_t touching = 0;
  for (std::size_t pose = 0; pose < cases(40, 4); ++pose) {
    Scene scene(a, b);
    scene.query.placement_a = randomPlacement(random, random.uniform(0, 2));
    scene.query.placement_b = randomPlacement(random, random.uniform(0, 1));
    SCOPED_TRACE(pose);
    for (Estimator estimator : {Estimator::raw, Estimator::volume_true})
      expectOracle(context, scene.query, estimator);
    touching += context.overlap(scene.query).pair_count > 0;
  }
  EXPECT_GT(touching, cases(20, 1));
}

TEST_P(OracleConformance, LargeSet) {
  QueryContext context = makeContext();
  const auto a = makeModel(randomSpheres(3000, 0.2, 30, 5)), b = makeModel(randomSpheres(2500, 0.2, 30, 6));
  Random random(7);
  Scene scene(a, b);
  scene.query.placement_b = randomPlacement(random, 0.4);
  expectOracle(context, scene.query);
  EXPECT_GT(context.overlap(scene.query).pair_count, 500u);
}

TEST_P(OracleConformance, ClusteredSets) {
  QueryContext context = makeContext();
  const auto a = makeModel(clusteredSpheres(400, 8, 1)), b = makeModel(clusteredSpheres(400, 8, 2));
  Random random(3);
  for (std::size_t pose = 0; pose < cases(10, 2); ++pose) {
    Scene scene(a, b);
    scene.query.placement_b = randomPlacement(random, random.uniform(0, 0.3));
    expectOracle(context, scene.query);
  }
}

TEST_P(OracleConformance, IdenticalSetsInTheSamePlace) {
  QueryContext context = makeContext();
  const auto model = makeModel(randomSpheres(300, 0.3, 20, 1), true);
  Scene scene(model, model);
  for (Estimator estimator : {Estimator::raw, Estimator::volume_true})
    expectOracle(context, scene.query, estimator);
  const Overlap overlap = context.overlap(scene.query, {Want::wrench, Estimator::raw});
  EXPECT_EQ(overlap.pair_count,
            model->packing().spheres.size());  // each sphere with itself, whose direction is none
  EXPECT_EQ(overlap.force, (Vec3d{0, 0, 0}));
}

TEST_P(OracleConformance, ConcentricSpheres) {
  QueryContext context = makeContext();
  const auto model = makeModel(concentricSpheres(40));
  Scene scene(model, model);
  expectOracle(context, scene.query);
  EXPECT_EQ(context.overlap(scene.query).pair_count, 1600u);
  for (double distance : {1e-300, 1e-170, 1e-160, 1e-30, 1e-12, 1e-6, 1e-3}) {
    SCOPED_TRACE(distance);
    scene.query.placement_b = at({distance, 0, 0});
    const Overlap overlap = context.overlap(scene.query);
    EXPECT_EQ(
        differenceInSums(bruteForce(scene.query, Estimator::raw), overlap, distance < 1e-150 ? 1 : 1e-9), "");
  }
}

TEST_P(OracleConformance, TouchingIsNotOverlapping) {
  QueryContext context = makeContext();
  const auto model = makeModel(lattice(4, 0.25));
  Scene scene(model, model);
  scene.query.placement_b = at({2, 0, 0});  // the lattices are 2 m wide: 16 pairs touch
  EXPECT_EQ(context.overlap(scene.query).pair_count, 0u);
  scene.query.placement_b = at({2 - 1e-12, 0, 0});
  EXPECT_EQ(context.overlap(scene.query).pair_count, 16u);
  scene.query.placement_b = at({1, 0.5, -0.5});  // sphere upon sphere, 2 x 3 x 3; the others only touch
  EXPECT_EQ(context.overlap(scene.query).pair_count, 18u);
  expectOracle(context, scene.query);
}

TEST_P(OracleConformance, NearlyTouchingKeepsItsDigits) {
  QueryContext context = makeContext();
  const auto model = makeModel({{0, 0, 0, 1}});
  Scene scene(model, model);
  for (double depth : {1e-3, 1e-6, 1e-9}) {
    scene.query.placement_b = at({2 - depth, 0, 0});
    SCOPED_TRACE(depth);
    expectOracle(context, scene.query, Estimator::raw, 1e-15 / depth + 1e-12);
  }
}

TEST_P(OracleConformance, OneInsideTheOther) {
  QueryContext context = makeContext();
  const auto shell = makeModel({{0, 0, 0, 10}});
  const auto inner = makeModel(randomSpheres(100, 0.3, 20, 4));
  Random random(9);
  for (int pose = 0; pose < 5; ++pose) {
    Scene scene(shell, inner);
    scene.query.placement_b = randomPlacement(random, 3);
    expectOracle(context, scene.query);
    EXPECT_EQ(context.overlap(scene.query).stiffness, 0);
    std::swap(scene.query.a, scene.query.b);
    std::swap(scene.query.placement_a, scene.query.placement_b);
    expectOracle(context, scene.query);
  }
}

TEST_P(OracleConformance, ExtremeRatios) {
  QueryContext context = makeContext();
  const auto a = makeModel(randomSpheres(600, 0.5, 1e4, 1)), b = makeModel(dust(600, 2));
  Random random(3);
  for (int pose = 0; pose < 6; ++pose) {
    Scene scene(a, b);
    scene.query.placement_b = randomPlacement(random, random.uniform(0, 1));
    expectOracle(context, scene.query);
  }
}

/// Two large balls that do not touch, and between them dust of both that does: the sums are small beside what
/// they might be.
TEST_P(OracleConformance, DustBetweenLargeBalls) {
  QueryContext context = makeContext();
  const auto ballWithDust = [](double side, std::uint64_t seed) {
    Random random(seed);
    Spheres spheres{{0, 0, 0, 0.5f}};
    for (int i = 0; i < 200; ++i) {
      const double x = side * (0.5 + random.uniform(1, 3) * 0.5e-4);
      spheres.push_back({static_cast<float>(x), static_cast<float>(random.uniform(-1e-3, 1e-3)),
                         static_cast<float>(random.uniform(-1e-3, 1e-3)), 0.5e-4f});
    }
    return makeModel(spheres);
  };
  const auto a = ballWithDust(1, 1), b = ballWithDust(-1, 2);
  for (double gap : {1.5e-4, 2.2e-4, 3e-4}) {
    SCOPED_TRACE(gap);
    Scene scene(a, b);
    scene.query.placement_b = at({1 + gap, 0, 0});
    expectOracle(context, scene.query);
    const Overlap overlap = context.overlap(scene.query);
    EXPECT_GT(overlap.pair_count, 0u);
    EXPECT_LT(overlap.volume, 1e-9);
  }
}

TEST_P(OracleConformance, Scales) {
  QueryContext context = makeContext();
  const auto a = makeModel(randomSpheres(200, 0.3, 20, 1), true),
             b = makeModel(randomSpheres(200, 0.3, 20, 2), true);
  Random random(3);
  for (double scale_a : {1e-6, 0.01, 1.0, 3.7, 1e5}) {
    for (double ratio : {0.02, 0.3, 1.0, 7.0, 1000.0}) {
      SCOPED_TRACE(testing::Message() << scale_a << " " << ratio);
      Scene scene(a, b);
      scene.query.placement_a = randomPlacement(random, 0.5 * scale_a, scale_a);
      scene.query.placement_b = randomPlacement(random, 0.7 * scale_a * ratio, scale_a * ratio);
      expectOracle(context, scene.query, Estimator::volume_true);
    }
  }
}

TEST_P(OracleConformance, Margins) {
  QueryContext context = makeContext();
  const auto a = makeModel(randomSpheres(200, 0.3, 100, 1), true),
             b = makeModel(randomSpheres(200, 0.3, 100, 2), true);
  Random random(3);
  for (double margin : {1e-9, 1e-4, 0.003, 0.02, 0.1, 1.0, 50.0}) {
    SCOPED_TRACE(margin);
    Scene scene(a, b);
    scene.query.margin = margin;
    scene.query.placement_a = randomPlacement(random, 1, 1.7);
    scene.query.placement_b = randomPlacement(random, 1, 0.6);
    for (Estimator estimator : {Estimator::raw, Estimator::volume_true})
      expectOracle(context, scene.query, estimator);
  }
}

TEST_P(OracleConformance, MarginReachesBodiesThatAreApart) {
  QueryContext context = makeContext();
  const auto model = makeModel({{0, 0, 0, 1}});
  Scene scene(model, model);
  scene.query.placement_b = at({2.5, 0, 0});
  EXPECT_EQ(context.overlap(scene.query).pair_count, 0u);
  scene.query.margin = 0.5;
  EXPECT_EQ(context.overlap(scene.query).pair_count, 0u);
  scene.query.margin = 0.501;
  EXPECT_EQ(context.overlap(scene.query).pair_count, 1u);
}

TEST_P(OracleConformance, Prefixes) {
  QueryContext context = makeContext();
  const auto a = makeModel(randomSpheres(300, 0.3, 20, 1), true),
             b = makeModel(randomSpheres(300, 0.3, 20, 2), true);
  Random random(3);
  for (std::uint32_t prefix_a : {0u, 1u, 10u, 100u, 1000000u}) {
    for (std::uint32_t prefix_b : {0u, 16u, 70u}) {
      SCOPED_TRACE(testing::Message() << prefix_a << " " << prefix_b);
      Scene scene(a, b);
      scene.query.prefix_a = prefix_a;
      scene.query.prefix_b = prefix_b;
      scene.query.placement_b = randomPlacement(random, 0.3);
      for (Estimator estimator : {Estimator::raw, Estimator::volume_true})
        expectOracle(context, scene.query, estimator);
    }
  }
}

TEST_P(OracleConformance, VolumeTrueUsesTheLongestStoredPrefix) {
  QueryContext context = makeContext();
  const auto model = makeModel(randomSpheres(300, 0.3, 20, 1), true);  // stored for 16, 64, 256, all
  Scene scene(model, model);
  scene.query.placement_b = at({0.1, 0.05, 0});
  const auto count = [&](std::uint32_t prefix) {
    scene.query.prefix_a = scene.query.prefix_b = prefix;
    return context.overlap(scene.query, {Want::wrench, Estimator::volume_true});
  };
  EXPECT_TRUE(sameBits(count(100), count(64)));
  EXPECT_FALSE(sameBits(count(64), count(63)));
}

INNERSPHERE_FOR_EACH_BACKEND(OracleConformance);

}  // namespace
}  // namespace innersphere::test
