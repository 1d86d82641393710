// Finds where a surface that bends lies on a sharp edge.
#pragma once

#include <functional>

#include "narrow_phase/edge_contacts.hpp"
#include "shape/sharp_edges.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// This is the point of a round surface that is nearest to a place, with the margin of its shape.
struct RoundPoint {
  btVector3 at{0, 0, 0};
  btVector3 normal{0, 0, 0};  ///< unit, out of the solid
};
/// Finds it. Returns false if it is not near. Samples are many: hand a std::cref(), which needs no memory.
using NearestRound = std::function<bool(const btVector3& place, RoundPoint& nearest)>;

/// Does what EdgeProbe::overEdge() says, for a solid with sharp edges, A or else B, and a surface that bends.
/// Positions are relative to A's origin, axes are those of the world.
EdgeProbe::FaceEnd lieOverEdge(const SharpEdges& solid, bool of_a, const NearestRound& nearest_round,
                               const OpposedPoints& points, const btVector3& to_top, EdgeContact& contact);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
