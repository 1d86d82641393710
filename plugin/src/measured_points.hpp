// Points of a patch whose depth was measured on the solids' surfaces.
#pragma once

#include <vector>

#include "contact_patch.hpp"
#include "gauge.hpp"
#include "patch_moments.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

struct PatchContacts {
  const std::vector<SphereContact>& contacts;
  const std::vector<std::size_t>& indices;  ///< those of the patch
  const PatchMoments& moments;
  const std::vector<std::uint64_t>& old_ids;  ///< points of the step before
  const Gauge& gauge;
  btScalar spacing;
};

/// Fills in points and normal; patch.count is 0 if no contact of the patch is near both surfaces.
void measuredPoints(const PatchContacts& from, ContactPatch& patch);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
