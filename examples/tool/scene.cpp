#include "scenes/scene.hpp"

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "exit_codes.hpp"
#include "scene_commands.hpp"

namespace innersphere::tool {
namespace {

int list(bool as_json) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const demo::Scene& scene : demo::scenes()) {
    rows.push_back({{"name", scene.name},
                    {"description", scene.description},
                    {"guards", scene.guards},
                    {"seconds", scene.seconds},
                    {"dt", scene.dt},
                    {"spheres", scene.spheres},
                    {"takes_meshes", scene.takes_solids}});
    if (!as_json) std::printf("%-12s %s\n", scene.name.c_str(), scene.description.c_str());
  }
  if (as_json) std::printf("%s\n", rows.dump(2).c_str());
  return kOk;
}

Command listCommand() {
  Command command("list", "Name the scenes");
  auto as_json = std::make_shared<bool>(false);
  command.flag("--json", *as_json, "Print JSON");
  command.examples = {"innersphere scene list"};
  command.run = [as_json] { return list(*as_json); };
  return command;
}

}  // namespace

Command sceneCommand() {
  Command command("scene", "List and run scenes of moving bodies");
  command.commands = {listCommand(), sceneRunCommand(), sceneCheckCommand(), sceneGalleryCommand()};
  command.examples = {"innersphere scene list", "innersphere scene run pile --html pile.html",
                      "innersphere scene check nut"};
  return command;
}

}  // namespace innersphere::tool
