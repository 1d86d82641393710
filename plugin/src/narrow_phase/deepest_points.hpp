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

/// Moves the first `count` samples a little uphill where they are near a top.
void ascendBeside(const SurfaceProbe& probe, std::size_t count, std::vector<ProbedSample>& samples);

/// Returns true if surfaces that touch are flat, or curved so that one lies in the other: their curvatures
/// add up to nothing, or to a small part of themselves. Then there is no deepest point to speak of.
bool fitTogether(btScalar curvature_a, btScalar curvature_b);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
