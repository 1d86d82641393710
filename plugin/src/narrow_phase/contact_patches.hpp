// Turns the contacts of single spheres into patches with points.
#pragma once

#include <vector>

#include "common/pair_motion.hpp"
#include "innersphere/overlap.hpp"
#include "narrow_phase/contact_point.hpp"
#include "narrow_phase/contact_settings.hpp"
#include "narrow_phase/packing_probe.hpp"
#include "narrow_phase/sample_selection.hpp"
#include "narrow_phase/shape_probe.hpp"
#include "narrow_phase/way_out.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Replaces `samples` by the contacts to probe. `patches` are those of the step before, whose points stay
/// among them. `reference` are axes that turn with a body: points keep their places in them.
void selectSamples(const std::vector<SphereContact>& contacts, const PackingProbe& probe,
                   const btMatrix3x3& reference, const std::vector<ContactPatch>& patches, Samples& samples);
void selectSamples(const std::vector<SphereContact>& contacts, const ShapeProbe& probe,
                   const ContactSettings& settings, const StepAhead& step, const btMatrix3x3& reference,
                   const std::vector<ContactPatch>& patches, Samples& samples);

/// Replaces `patches`, which hold those of the step before, by such whose depth is that of the solids'
/// surfaces: points are contacts of spheres, the deepest and those that span the patch, the old ones by
/// preference. Those of two packings are to have been carried to where the bodies are. Returns false if none
/// is near touching: the solids are apart, or so deep in each other that no surface is near.
bool refinePatches(Samples& samples, const PackingProbe& probe, const ContactSettings& settings,
                   const StepAhead& step, std::vector<ContactPatch>& patches);
bool refinePatches(Samples& samples, const ShapeProbe& probe, const ContactSettings& settings,
                   const StepAhead& step, std::vector<ContactPatch>& patches);

/// Replaces `patches` by one along the shortest way by which A leaves B, see findWayOut(), or by none: for
/// bodies deep in each other, where spheres push everywhere. `before` [m]: the way of the last search, or 0.
void wayOutPatch(const OverlappingPackings& packings, const btVector3& before, btScalar spacing,
                 const StepAhead& step, std::vector<ContactPatch>& patches);

/// Replaces `patches` by such whose points are placed by the moments of the overlap, with the mean depth
/// volume / area and its slope. `spacing` [m]: points closer to each other are one.
void volumePatches(const std::vector<SphereContact>& contacts, btScalar spacing, const btMatrix3x3& reference,
                   std::vector<ContactPatch>& patches);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
