// Bounds a solid in any direction.
#pragma once

#include <array>

#include <LinearMath/btTransform.h>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/packing.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Knows how far a solid reaches in the directions of a grid on a cube. How far it reaches (its support
/// function) is convex, so that what is interpolated between directions is never too little. Boxes around a
/// turned solid follow in constant time. They have 2 % more volume than the smallest in the mean; boxes
/// around its turned box have two to four times as much.
class SupportBounds {
 public:
  /// Of the surface and the spheres of a packing, in the frame to which `from_packing` takes it.
  SupportBounds(const Packing& packing, const btTransform& from_packing);

  /// Returns an upper bound of x . `direction` over all points x of the solid [m, times the length of the
  /// direction]. It is exact along the axes of the frame, and for a box along these axes in all directions;
  /// for others up to 3 % of the diagonal of their box above, where the direction is that of a large face.
  btScalar along(const btVector3& direction) const;

 private:
  static constexpr int kCells = 8;  ///< of an edge of the cube
  static constexpr int kFaces = 6, kRow = kCells + 1, kFace = kRow * kRow;

  std::array<btScalar, kFaces * kFace> reach_;  ///< along (1, y, z) and so on, y and z from -1 to 1
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
