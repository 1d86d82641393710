// The command `scene run`.
#pragma once

#include <CLI/CLI.hpp>

namespace innersphere::tool {

void addSceneRunCommand(CLI::App& scene);

}  // namespace innersphere::tool
