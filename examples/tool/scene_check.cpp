#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "exit_codes.hpp"
#include "report.hpp"
#include "scene_commands.hpp"
#include "scene_report.hpp"
#include "terminal.hpp"

namespace innersphere::tool {
namespace {

struct Arguments {
  std::vector<std::string> names;
  demo::SceneOptions options;
  bool json = false;
};

int run(Arguments& arguments) {
  std::vector<const demo::Scene*> chosen;
  for (const std::string& name : arguments.names) chosen.push_back(&demo::sceneNamed(name));
  if (chosen.empty()) {
    for (const demo::Scene& scene : demo::scenes()) chosen.push_back(&scene);
  }
  nlohmann::ordered_json results = nlohmann::ordered_json::array();
  bool all_hold = true;
  for (const demo::Scene* scene : chosen) {
    const std::string& name = scene->name;
    arguments.options.progress = progressOfScene(name);
    const demo::ScenePlay play = demo::play(*scene, arguments.options);
    clearProgressBar();
    const nlohmann::ordered_json truths = truthsJson(play.verdicts);
    results.push_back({{"scene", name},
                       {"guards", scene->guards},
                       {"truths", truths},
                       {"energy_gained", play.recording.energyGained()}});
    if (!arguments.json) std::printf("%s  (%s)\n", name.c_str(), scene->guards.c_str());
    for (const demo::Verdict& verdict : play.verdicts) {
      all_hold = all_hold && verdict.outcome != demo::Outcome::missed;
      if (!arguments.json) std::printf("  %s\n", describe(verdict).c_str());
    }
    if (!arguments.json) {
      std::printf("  energy  %.4g J in increments from step to step\n", play.recording.energyGained());
    }
    std::fflush(stdout);
  }
  if (arguments.json) std::printf("%s\n", results.dump(2).c_str());
  return all_hold ? kOk : kCheckFailed;
}

}  // namespace

Command sceneCheckCommand() {
  Command command("check", "Run scenes and compare them with what physics says");
  auto arguments = std::make_shared<Arguments>();
  command.arguments("NAMES", arguments->names, "Some of `innersphere scene list`; all if none is given")
      .oneOf(namesOfScenes());
  addSceneOptions(command, arguments->options);
  command.flag("--json", arguments->json, "Print the results as JSON");
  command.exit_status = "The exit status is 1 if a scene misses its truth.";
  command.examples = {"innersphere scene check nut peg"};
  command.run = [arguments] { return run(*arguments); };
  return command;
}

}  // namespace innersphere::tool
