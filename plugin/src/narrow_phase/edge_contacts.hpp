// Declares contacts at corners and at crossing edges.
#pragma once

#include <vector>

#include "narrow_phase/surface_probe.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// This is a corner over a face, or two edges that cross.
struct EdgeContact {
  OpposedPoints points;
  std::uint64_t id = 0;   ///< no sphere has it
  bool is_peak = true;    ///< the surface does not rise on from the corner
  bool is_alone = false;  ///< the crossing was found from an edge of B: its corners are over no face
};

/// Ids of corners and of crossings begin here; those of spheres are smaller.
constexpr std::uint64_t kCornerId = std::uint64_t(1) << 62;
constexpr std::uint64_t kCrossingId = std::uint64_t(1) << 61;

/// Finds contacts at corners and edges near opposed points of the surfaces.
class EdgeProbe {
 public:
  virtual ~EdgeProbe() = default;
  /// Appends the corners near opposed points where A (or else B) reaches furthest along `normal` (from A to
  /// B) and that are over the face of the other solid; also the far end of an edge that is level. Each comes
  /// with the point of the face that it is over. `vertices` is room to work in.
  virtual void corners(std::size_t index, const OpposedPoints& points, const btVector3& normal, bool of_a,
                       std::vector<std::uint32_t>& vertices, std::vector<EdgeContact>& corners) const = 0;
  /// Finds where, not far from opposed points of two flat faces, an edge of A crosses one of B, and both
  /// solids have nothing further out along the normal to both nearby. Returns false if none is found.
  /// `direction` is about that in which the solids are in contact, from A to B.
  virtual bool crossing(const OpposedPoints& points, const btVector3& direction,
                        EdgeContact& crossing) const = 0;
  /// Returns true if crossings are looked for where faces lie on each other, too: where a solid is thin.
  /// Faces that lean are deepest where one ends; there the ends are long, and points on faces not near them.
  virtual bool crossesOnFaces(const OpposedPoints&) const { return false; }
  /// Returns false if the point on B is known to lie on an edge, seen along no normal of its faces.
  virtual bool isOnFaceOfB(const OpposedPoints&) const { return true; }
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
