// Solids that lie nearly upon their copies: no more is found than there is, and errors are as foretold.
#include <cmath>
#include <memory>
#include <string>

#include "conformance.hpp"
#include "innersphere/bounded_query.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/solids.hpp"

namespace innersphere::test {
namespace {

constexpr Vec3d kBox{1, 0.8, 0.6};

class DeepCopies : public testing::TestWithParam<const char*> {
 protected:
  DeepCopies() {
    const std::string name = GetParam();
    PackOptions options;
    options.spheres = 500;
    if (name == "cup") options.order = SphereOrder::coverage;
    // Triangles are the solid itself, not chords of it.
    const auto solid = makeSolid((name == "box" ? makeBox(kBox) : makeNamedSolid(name))->surface(), name);
    model = std::make_shared<CollisionModel>(std::make_shared<Packing>(pack(*solid, options)));
    query.a = query.b = model.get();
    volume = model->packing().solid.volume;
    size = std::cbrt(volume);
  }

  double exact() { return context.overlap(query, {Want::volume, Estimator::surface}).volume; }
  Overlap found() { return context.overlap(query, {Want::wrench, Estimator::volume_true}); }

  QueryContext context{{Backend::cpu, 1}};
  std::shared_ptr<CollisionModel> model;
  PairQuery query;
  double volume, size;
};

TEST_P(DeepCopies, ShareNoMoreThanThereIs) {
  EXPECT_EQ(found().volume, volume);
  query.placement_b.translation = {1e-3 * size, 0, 0};
  EXPECT_LE(found().volume, volume);
  EXPECT_NEAR(found().volume, exact(), 0.02 * volume);
}

TEST_P(DeepCopies, ErrAsForetold) {
  Random random(1);
  int poses = 0, beyond = 0;
  double foretold = 0, measured = 0;
  while (poses < 100) {
    const double part = std::exp(random.uniform(-6, 0)), angle = random.uniform() < 0.5 ? part : 0;
    const double x = std::sin(angle), w = std::cos(angle);
    query.placement_b.rotation = {1, 0, 0, 0, w, -x, 0, x, w};
    query.placement_b.translation =
        angle > 0 && random.uniform() < 0.5 ? Vec3d{} : part * size * random.direction();
    const double truth = exact();
    if (truth < 0.5 * volume) continue;
    if (angle == 0 && GetParam() == std::string("box")) {
      double rest = 1;
      for (std::size_t k = 0; k < 3; ++k) rest *= kBox[k] - std::abs(query.placement_b.translation[k]);
      EXPECT_NEAR(truth, rest, 1e-6);
    }
    const Overlap overlap = found();
    EXPECT_LE(overlap.volume, volume);
    const ExpectedError expected = expectedError(query, Estimator::volume_true, overlap);
    const double error = std::abs(overlap.volume - truth) / std::max(overlap.volume, truth);
    ++poses;
    beyond += !(error <= expected.bound);
    foretold += expected.mean / 100;
    measured += error / 100;
  }
  EXPECT_LE(beyond, 5);
  EXPECT_GT(foretold, measured);
  EXPECT_LT(foretold, 3 * measured);
}

INSTANTIATE_TEST_SUITE_P(Solids, DeepCopies, testing::Values("box", "lbracket", "gear", "torus", "cup"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace innersphere::test
