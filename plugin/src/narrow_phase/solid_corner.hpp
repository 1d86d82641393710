// Finds the corners of a packed solid that reach furthest out, and the rims that they lie in.
#pragma once

#include <cstdint>
#include <vector>

#include "narrow_phase/edge_contacts.hpp"
#include "shape/placed_packing.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Finds the corners uphill from a triangle along `direction` (unit), no further than `distance` [m] from
/// `start`: their vertices replace `vertices`. Returns true if the first of them is a peak.
bool cornersUphill(const PlacedPacking& body, std::size_t triangle, const btVector3& direction,
                   const btVector3& start, btScalar distance, std::vector<std::uint32_t>& vertices);

/// Returns how much further than its spheres reach the end of a convex face may be furthest out: its radius
/// [m].
inline btScalar acrossBend(btScalar curvature) {
  return curvature > 0 ? 1 / curvature : btScalar(0);
}

/// Tells of a corner of a packed solid as it is seen along a way out of it (unit). It may lie in the rim of a
/// convex curved face, as do those at the end of a cylinder: of that whose normal is nearest to the way, if
/// that is less than 60 degrees off. All is relative to the origin of the packing, axes are the world's.
class SolidCorner {
 public:
  SolidCorner() = default;
  SolidCorner(const PlacedPacking& body, std::uint32_t vertex, const btVector3& way);

  /// Returns where it is, moved out along the way by the shape's margin; in a rim, where that is furthest out
  /// beside the vertex.
  const btVector3& at() const { return at_; }
  /// Returns true if it lies in a rim that goes on to corners further out.
  bool goesOn() const { return goes_on_; }
  /// Has a contact of A, or else B, belong to the face in whose rim it lies, and says which way that runs and
  /// how it bends. At the tip of a cone nothing bends.
  void giveTo(bool of_a, EdgeContact& contact) const;

 private:
  btVector3 at_{0, 0, 0};
  btVector3 normal_{0, 0, 0}, along_{0, 0, 0};
  btScalar curvature_ = 0, bend_along_ = 0;
  std::size_t triangle_ = OpposedPoints::kNone;
  bool goes_on_ = false, is_tip_ = false, is_end_ = false;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
