// Scenes show what physics says. What a scene is known to miss must not get worse.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <LinearMath/btScalar.h>

#include "scenes/scene.hpp"
#include "scenes/world.hpp"
#include "variants.hpp"

namespace innersphere::test {
namespace {

using demo::Outcome;

class Truth : public testing::TestWithParam<Variant> {};

TEST_P(Truth, IsShown) {
  expectTruths(GetParam(), Backend::cpu);
}

/// In double precision these take a minute each, and show no more than mixed-pile does.
std::vector<Variant> shortVariants() {
  std::vector<Variant> all = variants();
  const auto is_long = [](const Variant& variant) {
    return std::is_same_v<btScalar, double> &&
           (variant.scene == std::string_view("pile") || variant.scene == std::string_view("large-pile"));
  };
  all.erase(std::remove_if(all.begin(), all.end(), is_long), all.end());
  return all;
}

INSTANTIATE_TEST_SUITE_P(Of, Truth, testing::ValuesIn(shortVariants()), nameOf);

TEST(PenaltyResponse, KeepsEnergyAndMomentumWhereNothingDampsIt) {
  demo::SceneOptions options;
  options.spheres = 100;
  options.contact.backend = Backend::cpu;
  options.contact.response = Response::penalty;
  options.contact.damping = 0;
  const demo::ScenePlay play = demo::play(demo::sceneNamed("collisions"), options);
  // Without damping every impact is elastic, so the pair with restitution 1 has its truth.
  for (const int i : {0, 1}) {
    EXPECT_EQ(play.verdicts[static_cast<std::size_t>(i)].outcome, Outcome::holds);
  }
  const demo::StepRecord &first = play.recording.steps.front(), &last = play.recording.steps.back();
  EXPECT_NEAR(last.energy() / first.energy(), 1, 0.01);
  EXPECT_NEAR(last.momentum[0] / first.momentum[0], 1, 1e-5);
}

TEST(Catalogue, EverySceneIsTested) {
  // A new scene belongs into variants(), as it is.
  for (const demo::Scene& scene : demo::scenes()) {
    bool tested = false;
    for (const Variant& variant : variants())
      tested = tested || (variant.scene == scene.name && variant.spheres == 0);
    EXPECT_TRUE(tested) << scene.name;
    EXPECT_FALSE(scene.guards.empty()) << scene.name;
    EXPECT_EQ(scene.description.back(), '.') << scene.name;
  }
}

}  // namespace
}  // namespace innersphere::test
