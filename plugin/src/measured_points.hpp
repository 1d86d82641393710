// Contacts of a patch, measured on the solids' surfaces.
#pragma once

#include <vector>

#include "contact_patch.hpp"
#include "gauge.hpp"
#include "measure.hpp"
#include "patch_moments.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

struct PatchContacts {
  const std::vector<SphereContact>& contacts;
  const std::vector<std::size_t>& indices;  ///< those of the patch
  const PatchMoments& moments;
  const std::vector<std::uint64_t>& old_ids;  ///< points of the step before
  const Gauge& gauge;
  const Measure& measure;
};

/// A point and the part of the patch's area that it stands for.
struct MeasuredPoint {
  ContactPoint point;
  btScalar area;  ///< [m^2]
};

/// Appends those contacts of the patch that are on, or near, both surfaces.
void measurePoints(const PatchContacts& from, std::vector<MeasuredPoint>& found);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
