// Where a packing is in the world.
#pragma once

#include "innersphere/geometry.hpp"

namespace innersphere {

/// A similarity transform from the packing's frame to the world: x_world = scale * rotation * x +
/// translation. In double: the query forms the relative transform of two packings in double and goes to
/// single precision only in the frame of one of them, so results do not get worse far from the world's
/// origin.
struct Placement {
  Mat3d rotation{1, 0, 0, 0, 1,
                 0, 0, 0, 1};  ///< orthonormal, determinant +1, to within 1e-4 (then re-orthonormalised)
  Vec3d translation{};         ///< [m]
  double scale = 1;            ///< uniform, > 0
};

}  // namespace innersphere
