#include "scene_gallery.hpp"

#include <memory>
#include <string>
#include <vector>

#include "outputs.hpp"
#include "replay/replay.hpp"
#include "scene_report.hpp"
#include "scene_run.hpp"
#include "terminal.hpp"

namespace innersphere::tool {
namespace {

struct Arguments {
  std::vector<std::string> names{"pile", "chain-swing", "chain-heavy", "bowls",    "nut",  "gears",
                                 "peg",  "maze",        "card-house",  "chazelle", "flip", "cradle"};
  std::string output;
  demo::SceneOptions options;
  bool force = false;
};

demo::Film filmOf(const demo::Scene& scene, const demo::SceneOptions& options) {
  demo::ScenePlay play = demo::play(scene, options);
  addTexts(scene, play);
  return std::move(play.recording.film);
}

void run(Arguments& arguments) {
  checkOutput(arguments.output, arguments.force);
  std::vector<const demo::Scene*> chosen;
  for (const std::string& name : arguments.names) chosen.push_back(&demo::sceneNamed(name));
  std::vector<demo::Film> films;
  for (const demo::Scene* scene : chosen) {
    arguments.options.progress = progressOfScene(scene->name);
    films.push_back(filmOf(*scene, arguments.options));
    clearProgressBar();
  }
  writeTextOutput(arguments.output, arguments.force, demo::replayPage(films));
  say("wrote " + arguments.output);
}

}  // namespace

void addSceneGalleryCommand(CLI::App& scene) {
  CLI::App* command = scene.add_subcommand("gallery", "Run scenes and write one page that replays them");
  auto arguments = std::make_shared<Arguments>();
  command->add_option("NAMES", arguments->names, "Some of `innersphere scene list`")->capture_default_str();
  command->add_option("-o,--output", arguments->output, "HTML file: opens without a server and a network")
      ->required();
  addSceneOptions(*command, arguments->options);
  command->add_flag("--force", arguments->force, "Replace an existing output");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace innersphere::tool
