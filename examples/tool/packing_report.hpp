// What there is to say about a packing.
#pragma once

#include "innersphere/packing.hpp"
#include "report.hpp"

namespace innersphere::tool {

Report describe(const Packing& packing);

}  // namespace innersphere::tool
