// The tool's commands.
#pragma once

#include "command.hpp"

namespace innersphere::tool {

Command packCommand();
Command infoCommand();
Command checkCommand();
Command convertCommand();
Command viewCommand();
Command overlapCommand();
Command mergeCommand();
Command sceneCommand();
Command solidsCommand();

}  // namespace innersphere::tool
