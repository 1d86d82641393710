// Solids like those that users scan: uneven, with thin parts.
#pragma once

#include <memory>
#include <vector>

#include "innersphere/solid.hpp"

namespace innersphere::demo {

/// Three lumps, a head with two thin horns, and a horn that is hollow and open at its wide end.
std::vector<std::shared_ptr<const Solid>> scans();

}  // namespace innersphere::demo
