// Plans what the grid of some spheres will be like.
#pragma once

#include <cstddef>

#include "core/grid_plan.hpp"

namespace innersphere {

/// Plans the grid of 1 to 2^29 spheres with coordinates and radii up to 1e30. The plan depends on the
/// spheres, not on their order.
core::GridPlan planGrid(const Sphere* spheres, std::size_t count);

/// Returns a float that is not smaller than x.
float roundUp(double x);

}  // namespace innersphere
