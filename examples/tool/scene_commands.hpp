// The commands that run scenes, and what they share.
#pragma once

#include <string>
#include <vector>

#include "command.hpp"
#include "scenes/scene.hpp"

namespace innersphere::tool {

Command sceneRunCommand();
Command sceneCheckCommand();
Command sceneGalleryCommand();

std::vector<std::string> namesOfScenes();

/// Options of how scenes are run.
void addSceneOptions(Command& command, demo::SceneOptions& options);

/// A progress bar that says which of several scenes it is about.
Progress progressOfScene(const std::string& name);

}  // namespace innersphere::tool
