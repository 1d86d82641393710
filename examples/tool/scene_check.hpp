// The command `scene check`.
#pragma once

#include <CLI/CLI.hpp>

#include "commands.hpp"

namespace innersphere::tool {

void addSceneCheckCommand(CLI::App& scene, Session& session);

}  // namespace innersphere::tool
