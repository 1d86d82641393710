// The command `scene run`.
#pragma once

#include <CLI/CLI.hpp>

#include "commands.hpp"
#include "scenes/scene.hpp"

namespace innersphere::tool {

void addSceneRunCommand(CLI::App& scene, Session& session);

/// Options of how scenes are run, for the other commands that run them.
void addSceneOptions(CLI::App& command, demo::SceneOptions& options);

}  // namespace innersphere::tool
