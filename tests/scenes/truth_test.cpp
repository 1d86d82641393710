// Scenes show what physics says, in variants that take seconds. What a scene is known to miss must not get
// worse.
#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "innersphere/solids.hpp"
#include "scenes/scene.hpp"
#include "scenes/world.hpp"

namespace innersphere::test {
namespace {

using demo::Outcome;
using demo::Verdict;

struct Variant {
  const char* scene;
  std::size_t spheres = 500;
  double seconds = 0;  // 0: the scene's own
  double dt = 0;       // 0: the scene's own
  const char* name = "";

  friend void PrintTo(const Variant& v, std::ostream* out) { *out << v.scene << v.name; }
};

class Truth : public testing::TestWithParam<Variant> {};

TEST_P(Truth, IsShown) {
  const Variant& variant = GetParam();
  demo::SceneOptions options;
  options.spheres = variant.spheres;
  options.seconds = variant.seconds;
  options.dt = variant.dt;
  options.contact.backend = Backend::cpu;
  const demo::Scene& scene = demo::sceneNamed(variant.scene);
  if (scene.takes_solids)
    options.solids = {makeTorus(0.35, 0.15), makeNamedSolid("lbracket")};  // packed quickly
  const demo::ScenePlay play = demo::play(scene, options);
  ASSERT_FALSE(play.verdicts.empty());
  int shown = 0;
  for (const Verdict& verdict : play.verdicts) {
    if (verdict.outcome == Outcome::not_recorded) continue;
    ++shown;
    const demo::Truth& truth = verdict.truth;
    EXPECT_LE(demo::missOf(truth, verdict.measured), 1.5 * truth.known_miss)
        << truth.what << ": " << verdict.measured << " " << truth.unit << ", expected " << truth.expected
        << " +- " << truth.tolerance << " (" << truth.source << "). Guards: " << scene.guards;
  }
  EXPECT_GT(shown, 0);
  for (const demo::BodyState& state : play.recording.states) {
    for (const double x : state.position) ASSERT_TRUE(std::isfinite(x));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Of, Truth,
    testing::Values(Variant{"rest", 300, 2}, Variant{"soft", 1000, 2}, Variant{"drop", 300},
                    Variant{"bounce", 200}, Variant{"slide", 300}, Variant{"roll", 300, 0.6},
                    Variant{"flip", 300}, Variant{"torsion", 300, 0.5}, Variant{"cradle", 100, 1.5},
                    Variant{"collisions", 100, 1.5}, Variant{"tumble", 300}, Variant{"stack", 300, 2},
                    Variant{"card-house", 300, 2}, Variant{"mass-ratios", 300, 2},
                    Variant{"chain-hang", 500, 2}, Variant{"chain-hang", 500, 2, 1.0 / 60, "_at_60_Hz"},
                    Variant{"chain-swing", 500, 2}, Variant{"chain-heavy", 500, 2},
                    Variant{"chain-heavy", 500, 2, 1.0 / 60, "_at_60_Hz"}, Variant{"bowls", 500, 4},
                    Variant{"nut", 1000, 1.5}, Variant{"nut-held", 1000, 2}, Variant{"gears", 500, 3},
                    Variant{"peg", 500, 1.5}, Variant{"maze", 500}, Variant{"chazelle", 1000, 4},
                    Variant{"pile", 200, 1}, Variant{"large-pile", 100, 0.5}),
    [](const auto& info) {
      std::string name = std::string(info.param.scene) + info.param.name;
      for (char& c : name) c = c == '-' ? '_' : c;
      return name;
    });

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
  // A new scene belongs into the list above, with a variant that takes seconds.
  for (const demo::Scene& scene : demo::scenes()) {
    bool tested = false;
    const auto* unit = testing::UnitTest::GetInstance();
    for (int i = 0; i < unit->total_test_suite_count(); ++i) {
      const auto* suite = unit->GetTestSuite(i);
      for (int k = 0; k < suite->total_test_count(); ++k) {
        std::string name = scene.name;
        for (char& c : name) c = c == '-' ? '_' : c;
        tested = tested || suite->GetTestInfo(k)->name() == "IsShown/" + name;
      }
    }
    EXPECT_TRUE(tested) << scene.name;
    EXPECT_FALSE(scene.guards.empty()) << scene.name;
    EXPECT_EQ(scene.description.back(), '.') << scene.name;
  }
}

}  // namespace
}  // namespace innersphere::test
