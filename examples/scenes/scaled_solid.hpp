// A solid at another size.
#pragma once

#include <memory>

#include "innersphere/solid.hpp"

namespace innersphere::demo {

/// `solid` with all lengths multiplied by `scale`, > 0.
std::shared_ptr<const Solid> scaledSolid(std::shared_ptr<const Solid> solid, double scale);

/// Scales a solid so that the diagonal of its bounding box has this length [m].
std::shared_ptr<const Solid> withDiagonal(std::shared_ptr<const Solid> solid, double diagonal);

/// Length of the diagonal of a box [m].
double diagonalOf(const Bounds& bounds);

}  // namespace innersphere::demo
