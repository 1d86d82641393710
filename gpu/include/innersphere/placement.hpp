// Says where a packing is in the world.
#pragma once

#include "innersphere/packing.hpp"

namespace innersphere {

/// This is a similarity transform from the packing's frame to the world: x_world = scale * rotation * x +
/// translation. The query forms the relative transform of two packings in double precision and goes to single
/// precision only in the frame of one of them. So results do not get worse far from the world's origin.
struct Placement {
  /// The rotation: orthonormal with determinant +1 to within 1e-4. The query makes it orthonormal.
  Mat3d rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};
  Vec3d translation{};  ///< The translation [m].
  double scale = 1;     ///< The uniform scale, > 0.
};

/// Returns the placement of a solid's packing when the solid itself is at `solid`. The packing has a frame of
/// its own (see Packing::origin).
inline Placement placed(const Packing& packing, Placement solid) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      solid.translation[i] += solid.scale * solid.rotation[3 * i + j] * packing.origin[j];
    }
  }
  return solid;
}

}  // namespace innersphere
