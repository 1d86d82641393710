// Where the bodies are must not matter.
#include <cmath>

#include "conformance.hpp"

namespace innersphere::test {
namespace {

class PlacementConformance : public Conformance {};

TEST_P(PlacementConformance, FarFromTheOriginOfTheWorld) {
  QueryContext context = makeContext();
  const auto a = makeModel(randomSpheres(300, 0.3, 20, 1)), b = makeModel(randomSpheres(200, 0.3, 20, 2));
  Random random(3);
  Scene scene(a, b);
  scene.query.placement_a = randomPlacement(random, 0);
  scene.query.placement_b = randomPlacement(random, 0);
  scene.query.placement_b.translation = {0.5, 0.25, -0.125};
  const Overlap near = context.overlap(scene.query);
  const Vec3d far{1048576, -2097152, 524288};  // exactly representable together with the small offsets
  for (int i = 0; i < 3; ++i)
    scene.query.placement_a.translation[i] += far[i], scene.query.placement_b.translation[i] += far[i];
  EXPECT_TRUE(sameBits(near, context.overlap(scene.query)));
  EXPECT_GT(near.pair_count, 0u);
}

TEST_P(PlacementConformance, PackingFarFromItsOwnOrigin) {
  QueryContext context = makeContext();
  const auto a = makeModel(moved(randomSpheres(300, 0.3, 20, 1), {1000, 2000, -500}));
  const auto b = makeModel(moved(randomSpheres(200, 0.3, 20, 2), {-300, 0, 4000}));
  Random random(3);
  for (int pose = 0; pose < 5; ++pose) {
    Scene scene(a, b);
    scene.query.placement_a.rotation = random.rotation();
    scene.query.placement_b.rotation = random.rotation();
    const Mat3d &ra = scene.query.placement_a.rotation, &rb = scene.query.placement_b.rotation;
    for (int i = 0; i < 3; ++i) {  // the two clouds meet at half a metre
      scene.query.placement_b.translation[i] = ra[3 * i] * 1000 + ra[3 * i + 1] * 2000 - ra[3 * i + 2] * 500 +
                                               0.3 - (rb[3 * i] * -300 + rb[3 * i + 2] * 4000);
    }
    expectOracle(context, scene.query, Estimator::raw, 1e-7);
    EXPECT_GT(context.overlap(scene.query).pair_count, 0u);
  }
}

TEST_P(PlacementConformance, FarApart) {
  QueryContext context = makeContext();
  const auto model = makeModel(randomSpheres(100, 0.3, 20, 1));
  for (double distance : {3.0, 1e10, 1e150, 1e300}) {
    Scene scene(model, model);
    scene.query.placement_b = at({distance, -distance, distance});
    EXPECT_TRUE(sameBits(context.overlap(scene.query), Overlap{}));
  }
}

TEST_P(PlacementConformance, NearlyRigidRotationsAreMended) {
  QueryContext context = makeContext();
  const auto model = makeModel(randomSpheres(200, 0.3, 20, 1));
  Random random(3);
  Scene scene(model, model);
  scene.query.placement_b = randomPlacement(random, 0.4);
  const Overlap exact = context.overlap(scene.query);
  for (double& x : scene.query.placement_b.rotation) x *= 1 + 4e-5;  // as a matrix of many float products is
  const Overlap mended = context.overlap(scene.query);
  EXPECT_NEAR(mended.volume, exact.volume, 1e-12);
  EXPECT_NEAR(mended.force[0], exact.force[0], 1e-12);
}

TEST_P(PlacementConformance, ForceIsTheGradientOfEnergyAndAreaThatOfVolume) {
  QueryContext context = makeContext();
  const auto a = makeModel(randomSpheres(150, 0.3, 10, 1)), b = makeModel(randomSpheres(150, 0.3, 10, 2));
  Random random(3);
  Scene scene(a, b);
  scene.query.placement_a = randomPlacement(random, 1);
  scene.query.placement_b = randomPlacement(random, 1);
  const Overlap centre = context.overlap(scene.query);
  constexpr double kStep = 1e-6;
  for (int axis = 0; axis < 3; ++axis) {
    const auto moved = [&](double by) {
      PairQuery query = scene.query;
      query.placement_b.translation[axis] += by;
      return context.overlap(query);
    };
    const Overlap more = moved(kStep), less = moved(-kStep);
    EXPECT_NEAR(-(more.energy - less.energy) / (2 * kStep), centre.force[axis], 1e-6 * centre.volume);
    EXPECT_NEAR(-(more.volume - less.volume) / (2 * kStep), centre.area[axis], 1e-4 * centre.stiffness);
  }
  // The torque is the gradient with respect to a turn of B about its origin.
  for (int axis = 0; axis < 3; ++axis) {
    const auto turned = [&](double by) {
      PairQuery query = scene.query;
      const double c = std::cos(by), s = std::sin(by);
      const int y = (axis + 1) % 3, z = (axis + 2) % 3;
      for (int col = 0; col < 3; ++col) {
        const double ry = scene.query.placement_b.rotation[3 * y + col],
                     rz = scene.query.placement_b.rotation[3 * z + col];
        query.placement_b.rotation[3 * y + col] = c * ry - s * rz;
        query.placement_b.rotation[3 * z + col] = s * ry + c * rz;
      }
      return context.overlap(query);
    };
    EXPECT_NEAR(-(turned(kStep).energy - turned(-kStep).energy) / (2 * kStep), centre.torque[axis],
                1e-6 * centre.volume);
  }
}

INNERSPHERE_FOR_EACH_BACKEND(PlacementConformance);

}  // namespace
}  // namespace innersphere::test
