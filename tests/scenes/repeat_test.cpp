// Runs repeat to the last bit.
#include <gtest/gtest.h>

#include "scenes/scene.hpp"
#include "scenes/world.hpp"

namespace innersphere::test {
namespace {

class Repeat : public testing::TestWithParam<const char*> {};

TEST_P(Repeat, GivesTheSameBits) {
  demo::SceneOptions options;
  options.spheres = 100;
  options.seconds = 0.4;
  const auto once = demo::play(demo::sceneNamed(GetParam()), options);
  const auto again = demo::play(demo::sceneNamed(GetParam()), options);
  ASSERT_EQ(once.recording.states.size(), again.recording.states.size());
  for (std::size_t i = 0; i < once.recording.states.size(); ++i) {
    const demo::BodyState &a = once.recording.states[i], &b = again.recording.states[i];
    ASSERT_EQ(a.position, b.position) << "state " << i;
    ASSERT_EQ(a.rotation, b.rotation) << "state " << i;
    ASSERT_EQ(a.velocity, b.velocity) << "state " << i;
    ASSERT_EQ(a.spin, b.spin) << "state " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Repeat, testing::Values("slide", "chazelle", "gears"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace innersphere::test
