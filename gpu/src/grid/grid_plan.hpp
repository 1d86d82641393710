// What the grid of some spheres will be like.
#pragma once

#include <cstddef>

#include "core/grid_plan.hpp"

namespace innersphere {

/// For 1 to 2^29 spheres, coordinates and radii up to 1e30. Depends on the spheres only, not on their order.
core::GridPlan planGrid(const Sphere* spheres, std::size_t count);

/// A float that is not smaller.
float roundUp(double x);

}  // namespace innersphere
