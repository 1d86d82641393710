// Writes the options of a packing as text.
#pragma once

#include <string>

#include "innersphere/packer.hpp"

namespace innersphere {

/// Returns the options that change the spheres, as a command line.
std::string commandLine(const PackOptions& options);

}  // namespace innersphere
