// Which contacts of spheres are worth measuring on the surfaces.
#pragma once

#include <cstdint>
#include <vector>

#include "narrow_phase/contact_settings.hpp"
#include "narrow_phase/patch_moments.hpp"
#include "narrow_phase/surface_probe.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Contacts to measure, patch after patch.
struct Samples {
  struct OfPatch {
    btVector3 normal;  ///< unit, from A to B
    btScalar area;     ///< [m^2]
    btScalar radius;   ///< mean distance of the area from its centre [m]
    std::size_t end;   ///< behind its last index
  };
  /// Where a contact was measured last. It is measured there again first.
  struct Line {
    btVector3 direction{0, 0, 0};  ///< unit, from A to B; 0 if the line met no surfaces
    std::size_t triangle_a = 0;
    std::size_t triangle_b = 0;
  };
  std::vector<std::size_t> indices;  ///< of contacts
  std::vector<Line> lines;           ///< one for each of them, none before the first time
  std::vector<OfPatch> patches;
};

struct PatchContacts {
  const std::vector<SphereContact>& contacts;
  const std::vector<std::size_t>& indices;  ///< those of the patch
  const PatchMoments& moments;
  const std::vector<std::uint64_t>& old_ids;  ///< points of the step before
  const SurfaceProbe& probe;
  btScalar spacing;  ///< see ContactSettings
};

/// Turns all directions.
void turn(const btMatrix3x3& by, Samples& samples);

/// Leaves those that have been measured once, and were near enough to be measured again.
void dropUnprobed(Samples& samples);

/// Appends some contacts of a patch: those of the step before, those that span the patch, those that stand
/// out or face the other body most, and some of the others.
void appendSamples(const PatchContacts& from, Samples& samples);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
