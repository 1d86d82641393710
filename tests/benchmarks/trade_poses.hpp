// Pairs of solids that overlap a little, and what is known of their overlap.
#pragma once

#include <cstddef>
#include <vector>

#include "exact_poses.hpp"
#include "innersphere/solid.hpp"

namespace innersphere::benchmarks {

/// `count` copies of a solid in random orientations on random sides, each moved in from far away until about
/// `share` of its volume is inside the solid. Volumes are sampled; gradients are the integral of the normal
/// over the part of the copy's surface that is inside the solid. Shares no code with the query.
std::vector<ExactPose> touchingPoses(const Solid& solid, std::size_t count, double share);

}  // namespace innersphere::benchmarks
