// Finds the deepest points between curved surfaces.
#pragma once

#include <vector>

#include "narrow_phase/surface_probe.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Spheres sample a contact at places of their own. Where curved solids touch, the points that bear lie
/// between them: beside them a rolling body would brake, and one that lies on two hills would rock from one
/// to the other. Appends the tops of the four deepest hills of the depth, with ids of their own, as far as
/// they come within `separation` [m]. Marks the samples from which an ascent to one of them began.
void appendDeepestPoints(const SurfaceProbe& probe, btScalar separation, std::vector<ProbedSample>& samples);

/// Returns true if a place at `from_top` [m] from the top of a hill lies on that hill: if the slope there
/// leads to this top, or it is nearer to it than a part of `separation` [m].
bool isOnHill(const btVector3& from_top, const btVector3& slope, const Hill& hill, btScalar separation);

/// Moves the first `count` samples a little uphill where they are near a top.
void ascendBeside(const SurfaceProbe& probe, std::size_t count, std::vector<ProbedSample>& samples);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
