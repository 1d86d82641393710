// The command `scene gallery`.
#pragma once

#include <CLI/CLI.hpp>

namespace innersphere::tool {

void addSceneGalleryCommand(CLI::App& scene);

}  // namespace innersphere::tool
