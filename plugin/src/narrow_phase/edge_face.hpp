// Finds where a sharp edge lies on a flat face that ends before it does.
#pragma once

#include <vector>

#include "narrow_phase/edge_contacts.hpp"
#include "shape/sharp_edges.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Follows the face of A (or else B) at opposed points up to the sharp edge in which it ends, seen along
/// `normal` (unit, from A to B: of the other solid's flat face), and that edge both ways to where the other
/// face ends. Appends these places. Returns true if the edge goes on beyond the other face both ways: else
/// one of its own ends is over that face. Positions are relative to A's origin, axes are those of the world.
bool layEdgeOnFace(const SharpEdges& a, const SharpEdges& b, bool of_a, const OpposedPoints& points,
                   const btVector3& normal, std::vector<EdgeContact>& ends);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
