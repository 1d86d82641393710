#include "scenes/scene.hpp"

#include "commands.hpp"
#include "scene_check.hpp"
#include "scene_gallery.hpp"
#include "scene_run.hpp"

namespace innersphere::tool {

void addSceneCommand(CLI::App& app, Session& session) {
  CLI::App* command = app.add_subcommand("scene", "List and run scenes of moving bodies");
  command->require_subcommand(1);
  command->fallthrough();
  CLI::App* list = command->add_subcommand("list", "Name the scenes");
  list->callback([] {
    for (const demo::Scene& scene : demo::scenes()) {
      std::printf("%-12s %s\n", scene.name.c_str(), scene.description.c_str());
    }
  });
  addSceneRunCommand(*command, session);
  addSceneCheckCommand(*command, session);
  addSceneGalleryCommand(*command);
}

}  // namespace innersphere::tool
