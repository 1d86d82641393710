// Declares contacts at corners and at crossing edges.
#pragma once

#include <vector>

#include "common/contact_tolerances.hpp"
#include "narrow_phase/surface_probe.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// This is a corner over a face, or two edges that cross.
struct EdgeContact {
  OpposedPoints points;
  std::uint64_t id = 0;      ///< no sphere has it
  bool is_peak = true;       ///< the surface does not rise on from the corner
  bool is_end = false;       ///< what bends ends there: in a tip, or in a sharp edge
  bool is_beside = false;    ///< it lies in a rim that goes on to deeper corners: it bears nothing
  btVector3 along{0, 0, 0};  ///< unit, of a rim, or of an edge that what is round lies on
  btScalar bend_along = 0;   ///< how fast the depth falls along a rim [1/m]
  bool is_alone = false;     ///< the crossing was found from an edge of B: its corners are over no face
};

/// Ids of corners and of crossings begin here; those of spheres are smaller.
constexpr std::uint64_t kCornerId = std::uint64_t(1) << 62;
constexpr std::uint64_t kCrossingId = std::uint64_t(1) << 61;

/// Names the crossing of two edges by their ids.
inline std::uint64_t crossingId(std::uint32_t edge_a, std::uint32_t edge_b) {
  return kCrossingId + (std::uint64_t(edge_a) << 30) + edge_b;
}

/// Holds the outlines of what faces that lie on each other have in common, in one patch.
struct FaceOverlaps {
  struct Side {
    btVector3 from, to;
  };
  std::vector<Side> sides;
  int sides_left = 0;  ///< that may be looked for

  void clear() {
    sides.clear();
    sides_left = kOverlapSides;
  }
  bool hasRoom() const { return sides_left > 0; }
  /// Returns true if an outline is around a place, seen along `normal`.
  bool covers(const btVector3& place, const btVector3& normal) const;
};

/// Finds contacts at corners and edges near opposed points of the surfaces.
class EdgeProbe {
 public:
  virtual ~EdgeProbe() = default;
  /// Appends the corners near opposed points where A (or else B) reaches furthest along `normal` (from A to
  /// B) and that are over the face of the other solid; also the far end of an edge that is level. Each comes
  /// with the point of the face that it is over. `vertices` is room to work in.
  virtual void corners(std::size_t index, const OpposedPoints& points, const btVector3& normal, bool of_a,
                       std::vector<std::uint32_t>& vertices, std::vector<EdgeContact>& corners) const = 0;
  /// Returns false if it is known that what bends of A, or else B, ends nowhere.
  virtual bool hasEnds(bool of_a) const = 0;
  /// Finds where, not far from opposed points of two flat faces, an edge of A crosses one of B, and both
  /// solids have nothing further out along the normal to both nearby. Returns false if none is found.
  /// `direction` is about that in which the solids are in contact, from A to B.
  virtual bool crossing(const OpposedPoints& points, const btVector3& direction,
                        EdgeContact& crossing) const = 0;
  /// Follows the outline of what two flat faces that lie on each other have in common, from opposed points of
  /// them: see followOverlap(). Appends where edges of both cross.
  virtual void overlap(const OpposedPoints& points, const btVector3& normal, FaceOverlaps& overlaps,
                       std::vector<EdgeContact>& crossings) const = 0;
  /// Finds where a sharp edge of A, or else B, ends on the flat face of the other solid, because that ends:
  /// see layEdgeOnFace(). Returns true if it does so both ways.
  virtual bool edgeOnFace(const OpposedPoints& points, bool of_a, const btVector3& normal,
                          std::vector<EdgeContact>& ends) const = 0;
  /// Says where a face bears.
  enum class FaceEnd {
    unknown,
    on_face,  ///< where both normals agree
    beyond,   ///< not there: it ends before, in an edge
    in_edge,  ///< in that edge
  };
  /// Finds where a sharp edge of the one solid, A or else B, is deepest in the other one, which bends: that
  /// edge in which the flat face at opposed points ends before the way across it `to_top`, where the contact
  /// would be deepest. By default it is not known.
  virtual FaceEnd overEdge(const OpposedPoints&, bool, const btVector3&, EdgeContact&) const {
    return FaceEnd::unknown;
  }
  /// Appends the ends of the line in which B, which bends one way only, lies on the flat face of A at opposed
  /// points, as far as that face is there. By default they are not known.
  virtual void lineEnds(const OpposedPoints&, std::vector<EdgeContact>&) const {}
  /// Returns false if the point on B is known to lie on an edge, seen along no normal of its faces.
  virtual bool isOnFaceOfB(const OpposedPoints&) const { return true; }
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
