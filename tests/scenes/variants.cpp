#include "variants.hpp"

#include <cmath>

#include "innersphere/solids.hpp"
#include "scenes/scene.hpp"
#include "scenes/world.hpp"

namespace innersphere::test {

const std::vector<Variant>& variants() {
  static const std::vector<Variant> all = {{"rest", 300, 2},
                                           {"soft", 1000, 2},
                                           {"drop", 300},
                                           {"bounce", 200},
                                           {"bounce", 200, 0, 1.0 / 2000, "_at_2000_Hz"},
                                           {"slide", 300},
                                           {"roll", 300, 0.6},
                                           {"flip", 300},
                                           {"torsion", 300, 0.5},
                                           {"cradle", 100},
                                           {"collisions", 100, 1.5},
                                           {"tumble", 300},
                                           {"stack", 300},
                                           {"card-house", 300, 2},
                                           {"mass-ratios", 300, 2},
                                           {"chain-hang", 500, 2},
                                           {"chain-hang", 500, 2, 1.0 / 60, "_at_60_Hz"},
                                           {"chain-swing", 500, 2},
                                           {"chain-heavy", 500, 2},
                                           {"chain-heavy", 500, 5, 1.0 / 60, "_at_60_Hz"},
                                           {"bowls", 500, 4},
                                           {"nut", 1000, 1.5},
                                           {"nut-held", 1000, 2},
                                           {"gears", 500, 3},
                                           {"peg", 500, 1.5},
                                           {"maze", 500},
                                           {"chazelle", 1000, 4},
                                           {"pile", 200, 1},
                                           {"large-pile", 100, 0.5}};
  return all;
}

std::string nameOf(const testing::TestParamInfo<Variant>& info) {
  std::string name = std::string(info.param.scene) + info.param.name;
  for (char& c : name) c = c == '-' ? '_' : c;
  return name;
}

void expectTruths(const Variant& variant, Backend backend) {
  demo::SceneOptions options;
  options.spheres = variant.spheres;
  options.seconds = variant.seconds;
  options.dt = variant.dt;
  options.contact.backend = backend;
  const demo::Scene& scene = demo::sceneNamed(variant.scene);
  if (scene.takes_solids)
    options.solids = {makeTorus(0.35, 0.15), makeNamedSolid("lbracket")};  // packed quickly
  const demo::ScenePlay play = demo::play(scene, options);
  ASSERT_FALSE(play.verdicts.empty());
  int shown = 0;
  for (const demo::Verdict& verdict : play.verdicts) {
    if (verdict.outcome == demo::Outcome::not_recorded) continue;
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

}  // namespace innersphere::test
