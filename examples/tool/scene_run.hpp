// The command `scene run`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "commands.hpp"
#include "scenes/scene.hpp"

namespace innersphere::tool {

void addSceneRunCommand(CLI::App& scene, Session& session);

/// Options of how scenes are run, for the other commands that run them.
void addSceneOptions(CLI::App& command, demo::SceneOptions& options);

/// A progress bar that says which of several scenes it is about.
Progress progressOfScene(const std::string& name);

}  // namespace innersphere::tool
