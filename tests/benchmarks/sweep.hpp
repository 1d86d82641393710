// The poses that Weller, Frese and Zachmann 2013 measure with.
#pragma once

#include <vector>

#include "innersphere/placement.hpp"

namespace innersphere::benchmarks {

/// Placements of a copy of a solid with this box: turned about the box' centre by count equal angles from 0
/// to 360 degrees, and shifted by half the box' size along x.
std::vector<Placement> sweepPoses(const Bounds& box, const Vec3d& axis, std::size_t count);

}  // namespace innersphere::benchmarks
