// What there is to say about a packing.
#pragma once

#include <vector>

#include "innersphere/packing.hpp"
#include "report.hpp"

namespace innersphere::tool {

Report describe(const Packing& packing);

/// Adds the range of the spheres' densities, or that there are none.
void addMassWeights(const std::vector<float>& weights, Report& report);

}  // namespace innersphere::tool
