// What there is to say about a packing.
#pragma once

#include "innersphere/covering.hpp"
#include "innersphere/packing.hpp"
#include "report.hpp"

namespace innersphere::tool {

Report describe(const Packing& packing);

/// Describes a covering or clump. `diagonal`: that of its solid [m]; lengths are compared with it unless it
/// is 0.
Report describe(const Covering& covering, double diagonal = 0);

}  // namespace innersphere::tool
