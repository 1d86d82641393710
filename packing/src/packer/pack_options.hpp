// The options of a packing as text.
#pragma once

#include <string>

#include "innersphere/packer.hpp"

namespace innersphere {

/// Those that change the result, as a command line.
std::string commandLine(const PackOptions& options);

}  // namespace innersphere
