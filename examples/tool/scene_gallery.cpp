#include <memory>
#include <string>
#include <vector>

#include "exit_codes.hpp"
#include "outputs.hpp"
#include "replay/replay.hpp"
#include "scene_commands.hpp"
#include "scene_report.hpp"
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

Command sceneGalleryCommand() {
  Command command("gallery", "Run scenes and write one page that replays them");
  auto arguments = std::make_shared<Arguments>();
  command.arguments("NAMES", arguments->names, "Some of `innersphere scene list`").oneOf(namesOfScenes());
  Option& output = command.text("-o,--output", arguments->output,
                                "HTML file: opens without a server and a network; -: to stdout");
  output.withFile().required = true;
  addSceneOptions(command, arguments->options);
  command.flag("--force", arguments->force, "Replace an existing output");
  command.examples = {"innersphere scene gallery pile nut gears -o gallery.html"};
  command.run = [arguments] {
    run(*arguments);
    return kOk;
  };
  return command;
}

}  // namespace innersphere::tool
