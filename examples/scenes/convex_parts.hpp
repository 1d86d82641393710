// A solid cut into convex parts, as Bullet's users do it.
#pragma once

#include <vector>

#include "innersphere/solid.hpp"

namespace innersphere::demo {

/// Cuts a solid into sectors about the vertical axis through the middle of its bounding box, and these into
/// layers, until the convex hull of each part leaves the solid by no more than `concavity` [m], > 0. Each
/// result is the points that a hull is made of. Good for what is turned or ring-shaped; of no use for
/// anything.
std::vector<std::vector<Vec3d>> convexParts(const Solid& solid, double concavity);

}  // namespace innersphere::demo
