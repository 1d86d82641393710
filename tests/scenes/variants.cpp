#include "variants.hpp"

#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>

#include "scenes/scene.hpp"
#include "scenes/world.hpp"

namespace innersphere::test {

const std::vector<Variant>& variants() {
  constexpr auto kBullet = demo::SolverKind::bullet, kSubstep = demo::SolverKind::substep;
  static const std::vector<Variant> all = {{"rest"},
                                           {"rest", 300, 2, 0, "_of_300_spheres"},
                                           {"soft"},
                                           {"soft", 1000, 2, 0, "_of_1000_spheres"},
                                           {"drop"},
                                           {"bounce"},
                                           {"bounce", 200, 0, 1.0 / 2000, "_at_2000_Hz"},
                                           {"slide"},
                                           {"roll"},
                                           {"flip"},
                                           {"torsion"},
                                           {"torsion", 300, 0, 0, "_of_300_spheres"},
                                           {"cradle"},
                                           {"collisions"},
                                           {"tumble"},
                                           {"stack"},
                                           {"stack", 300, 0, 0, "_of_300_spheres"},
                                           {"card-house"},
                                           {"mass-ratios"},
                                           {"chain-hang"},
                                           {"chain-hang", 256, 0, 0, "_of_256_spheres"},
                                           {"chain-hang", 500, 2, 1.0 / 60, "_at_60_Hz"},
                                           {"chain-swing"},
                                           {"chain-swing", 500, 2, 1.0 / 60, "_at_60_Hz"},
                                           {"chain-heavy"},
                                           {"chain-heavy", 500, 5, 1.0 / 60, "_at_60_Hz", kBullet, 3},
                                           {"bowls"},
                                           {"bowls", 500, 4, 0, "_of_500_spheres"},
                                           {"nut"},
                                           {"nut", 1000, 0, 0, "_of_1000_spheres"},
                                           {"nut-held"},
                                           {"gears"},
                                           {"peg"},
                                           {"maze"},
                                           {"chazelle"},
                                           {"pile", 0, 0, 0, "", kBullet, 3},
                                           {"large-pile", 0, 0, 0, "", kBullet, 3},
                                           {"arch"},
                                           {"arch-thin"},
                                           {"dominoes"},
                                           {"ring-peg"},
                                           {"ring-cylinder"},
                                           {"half-pipe"},
                                           {"half-pipe-mesh"},
                                           {"t-slot"},
                                           {"t-slot", 0, 0, 1.0 / 60, "_at_60_Hz"},
                                           {"t-slot", 0, 0, 0.0161, "_at_62_Hz"},
                                           {"gripper"},
                                           {"gripper-motor"},
                                           {"carabiner"},
                                           {"chain-rest"},
                                           {"chain-rest", 0, 0, 1.0 / 60, "_at_60_Hz"},
                                           {"chain-rest", 1000, 0, 1.0 / 60, "_of_1000_spheres_at_60_Hz"},
                                           {"drops"},
                                           {"gear-box"},
                                           {"gear-plane"},
                                           {"gear-mesh"},
                                           {"mixed-pile", 0, 4},
                                           {"scan-bin", 0, 3},
                                           // Where the place of contact goes over saddles in a step.
                                           {"roll", 0, 0, 1.0 / 60, "_in_substeps", kSubstep},
                                           {"half-pipe-mesh", 0, 0, 1.0 / 60, "_in_substeps", kSubstep},
                                           {"chain-rest", 0, 0, 1.0 / 60, "_in_substeps", kSubstep}};
  return all;
}

std::string nameOf(const testing::TestParamInfo<Variant>& info) {
  std::string name = std::string(info.param.scene) + info.param.name;
  for (char& c : name) c = c == '-' ? '_' : c;
  return name;
}

namespace {

/// Names the truths that a run misses by more than is known; nothing if it shows all.
std::string missesOf(const demo::ScenePlay& play) {
  std::ostringstream misses;
  int shown = 0;
  for (const demo::Verdict& verdict : play.verdicts) {
    if (verdict.outcome == demo::Outcome::not_recorded) continue;
    ++shown;
    const demo::Truth& truth = verdict.truth;
    if (demo::missOf(truth, verdict.measured) <= 1.5 * truth.known_miss) continue;
    misses << truth.what << ": " << verdict.measured << " " << truth.unit << ", expected " << truth.expected
           << " +- " << truth.tolerance << " (" << truth.source << ").\n";
  }
  if (shown == 0) misses << "No truth was recorded.\n";
  return misses.str();
}

}  // namespace

void expectTruths(const Variant& variant, Backend backend) {
  const demo::Scene& scene = demo::sceneNamed(variant.scene);
  const int may_miss = variant.runs / 3;
  int missed = 0;
  std::string misses;
  // What is decided needs no further run: these scenes take longest.
  for (int run = 0; missed <= may_miss && run - missed < variant.runs - may_miss; ++run) {
    demo::SceneOptions options;
    options.spheres = variant.spheres + std::size_t(run) * variant.spheres / 10;
    options.seed += std::uint64_t(run);
    options.seconds = variant.seconds;
    options.dt = variant.dt;
    options.solver.kind = variant.solver;
    options.contact.backend = backend;
    const demo::ScenePlay play = demo::play(scene, options);
    for (const demo::BodyState& state : play.recording.states) {
      for (const double x : state.position) ASSERT_TRUE(std::isfinite(x));
    }
    const std::string of_run = missesOf(play);
    if (of_run.empty()) continue;
    ++missed;
    misses += "Run " + std::to_string(run + 1) + ": " + of_run;
  }
  EXPECT_LE(missed, may_miss) << misses << "Guards: " << scene.guards;
}

}  // namespace innersphere::test
