// Tells contacts that will be from those of bodies that pass each other.
#pragma once

#include <vector>

#include "common/pair_motion.hpp"
#include "narrow_phase/contact_samples.hpp"
#include "narrow_phase/surface_probe.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Points that are apart are handed to the solver as if both surfaces went on beside them: a body that falls
/// past a ledge would hit it. Drops those of which, as the bodies move now, neither A's point meets B nor B's
/// point A. What is met by less than a thousandth of the smaller body's size beside an edge is passed, too,
/// or by less than twice the depth at rest, also where it touches already, however far in front of the edge:
/// so much bodies are in what they lie on, and the next tile of a floor is no wall. Where edges cross, or
/// both surfaces bend, other places of them may meet: these points stay, and so do those of swept bodies.
void dropPassing(const SurfaceProbe& probe, const StepAhead& step, std::vector<WeightedPoint>& found);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
