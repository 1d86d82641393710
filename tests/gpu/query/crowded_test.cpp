// Spheres so close together that one cell lists a great many of them: nothing has a place for only so many.
#include "conformance.hpp"

namespace innersphere::test {
namespace {

class CrowdedConformance : public Conformance {};

/// Nearly concentric spheres of one size: legal, though no packing.
Spheres crowd(std::size_t count, double radius, std::uint64_t seed) {
  Random random(seed);
  Spheres spheres;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d d = random.direction();
    const double at = radius * random.uniform(0, 0.2);
    spheres.push_back({static_cast<float>(at * d[0]), static_cast<float>(at * d[1]),
                       static_cast<float>(at * d[2]), static_cast<float>(radius)});
  }
  return spheres;
}

TEST_P(CrowdedConformance, AnyNumberInACell) {
  QueryContext context = makeContext();
  const auto few = makeModel(crowd(20, 0.25, 1));
  std::vector<std::size_t> counts{513, 500, 2100, 5000};
  counts.resize(cases(4, 1));
  for (const std::size_t count : counts) {
    SCOPED_TRACE(count);
    const auto many = makeModel(crowd(count, 0.25, 2));
    Random random(count);
    for (const double distance : {0.1, 0.45}) {
      Scene scene(few, many);
      scene.query.placement_a = randomPlacement(random, 0);
      scene.query.placement_b = randomPlacement(random, distance);
      expectOracle(context, scene.query);
      scene.query.margin = 0.1;  // now they look into several cells
      expectOracle(context, scene.query);
    }
  }
}

TEST_P(CrowdedConformance, SmallOnesAroundALargeOne) {
  QueryContext context = makeContext();
  Spheres spheres = crowd(cases(3000, 600), 0.01, 3);
  spheres.insert(spheres.begin(), Sphere{0, 0, 0, 3});
  const auto model = makeModel(spheres), one = makeModel({{0, 0, 0, 0.005f}});
  for (const double distance : {0.0, 0.01, 0.5, 3.004}) {
    Scene scene(model, one);
    scene.query.placement_b = at({distance, 0, 0});
    expectOracle(context, scene.query);
    EXPECT_GT(context.overlap(scene.query).pair_count, 0u);
  }
}

INNERSPHERE_FOR_EACH_BACKEND(CrowdedConformance);

}  // namespace
}  // namespace innersphere::test
