// Where a packing is in the world.
#pragma once

#include "innersphere/packing.hpp"

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

/// Where the packing of a solid is, when the solid itself is at `solid`: the packing has a frame of its own
/// (see Packing::origin).
inline Placement placed(const Packing& packing, Placement solid) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      solid.translation[i] += solid.scale * solid.rotation[3 * i + j] * packing.origin[j];
    }
  }
  return solid;
}

}  // namespace innersphere
