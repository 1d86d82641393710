// Finds the outline of what two flat faces that lie on each other have in common.
#pragma once

#include <vector>

#include "narrow_phase/edge_contacts.hpp"
#include "shape/sharp_edges.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Walks from opposed points of two faces to the first sharp edge of either, and around along the edges of
/// both, while `overlaps` has room. Appends where edges of both cross, and adds the outline to `overlaps`.
/// Positions are relative to A's origin, axes are those of the world.
void followOverlap(const SharpEdges& a, const SharpEdges& b, const OpposedPoints& points,
                   const btVector3& normal, FaceOverlaps& overlaps, std::vector<EdgeContact>& crossings);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
