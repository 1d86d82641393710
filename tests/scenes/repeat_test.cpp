// Runs repeat to the last bit.
#include <gtest/gtest.h>

#include "same_motion.hpp"
#include "scenes/scene.hpp"
#include "scenes/world.hpp"

namespace innersphere::test {
namespace {

class Repeat : public testing::TestWithParam<const char*> {};

TEST_P(Repeat, GivesTheSameBits) {
  demo::SceneOptions options;
  options.spheres = 100;
  options.seconds = 0.4;
  const demo::Scene& scene = demo::sceneNamed(GetParam());
  expectSameMotion(demo::play(scene, options).recording, demo::play(scene, options).recording);
}

INSTANTIATE_TEST_SUITE_P(Of, Repeat, testing::Values("slide", "chazelle", "gears"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace innersphere::test
