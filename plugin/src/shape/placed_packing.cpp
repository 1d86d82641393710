#include "shape/placed_packing.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

PlacedPacking::PlacedPacking(const PackingShape& packing_shape, const btTransform& body, Estimator estimator,
                             btScalar search_distance, const Prefix* spheres)
    : impl(&packing_shape.impl()),
      prefix(spheres != nullptr ? spheres : impl->prefix),
      world(impl->toWorld(body)),
      margin(packing_shape.getMargin()),
      search_margin(search_distance) {
  if (estimator != Estimator::volume_true || prefix->volume_true == nullptr) return;
  prefix = &impl->solid->prefix(prefix->volume_true->count);
  radii = prefix->volume_true->radii.data();
  excess = prefix->largest_overshoot * scale();
}

Placement PlacedPacking::placement() const {
  Placement p;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) p.rotation[3 * i + j] = world.getBasis()[i][j];
    p.translation[i] = world.getOrigin()[i];
  }
  p.scale = scale();
  return p;
}

bool PlacedPacking::nearest(const btVector3& place, btScalar max_distance,
                            SurfaceQueries::Nearest& nearest) const {
  const btMatrix3x3& axes = world.getBasis();
  if (!impl->surfaceQueries().nearest((place * axes) / scale(), max_distance / scale(), nearest))
    return false;
  nearest.distance *= scale();
  nearest.normal = axes * nearest.normal;
  return true;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
