// Finds where sharp edges of two solids cross.
#pragma once

#include <functional>

#include "narrow_phase/edge_contacts.hpp"
#include "shape/sharp_edges.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Returns true if a solid is thin. Only faces that fall away from their edge by little ask for it.
using IsThin = std::function<bool()>;

/// Says where the lines through two edges are nearest to each other.
struct LineCrossing {
  btScalar share_first;   ///< of the first edge
  btScalar share_second;  ///< of the second
  btVector3 across;       ///< unit, of both

  /// Returns true if it is not beyond an end of either.
  bool isOnBoth() const;
};
/// Finds it. Returns false if they are parallel, but for 5 degrees.
bool crossLines(const SharpEdges::Edge& first, const SharpEdges::Edge& second, LineCrossing& crossing);

/// Does what EdgeProbe::crossing() says. Positions are relative to A's origin, axes are those of the world.
bool crossEdges(const SharpEdges& a, const SharpEdges& b, const OpposedPoints& points,
                const btVector3& direction, EdgeContact& crossing, const IsThin& is_thin = {});

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
