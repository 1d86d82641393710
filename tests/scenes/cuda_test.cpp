// Scenes on a CUDA device: they show their truths, and move as they do on the CPU.
#include <gtest/gtest.h>

#include "device.hpp"
#include "same_motion.hpp"
#include "scenes/scene.hpp"
#include "scenes/world.hpp"
#include "variants.hpp"

namespace innersphere::test {
namespace {

class OnADevice : public testing::TestWithParam<Variant> {
 protected:
  void SetUp() override { needDevice(); }
};

TEST_P(OnADevice, TruthIsShown) {
  expectTruths(GetParam(), Backend::cuda);
}

TEST_P(OnADevice, BodiesMoveAsOnTheCpu) {
  const auto recordingOn = [](Backend backend) {
    demo::SceneOptions options;
    options.spheres = 100;
    options.seconds = 0.3;
    options.dt = GetParam().dt;
    options.contact.backend = backend;
    return demo::play(demo::sceneNamed(GetParam().scene), options).recording;
  };
  expectSameMotion(recordingOn(Backend::cpu), recordingOn(Backend::cuda));
}

INSTANTIATE_TEST_SUITE_P(Of, OnADevice, testing::ValuesIn(variants()), nameOf);

}  // namespace
}  // namespace innersphere::test
