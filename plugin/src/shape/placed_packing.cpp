#include "shape/placed_packing.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

PackingBody::PackingBody(const PackingShape& packing_shape, const btTransform& body, Estimator estimator,
                         btScalar search_slack, const Prefix* spheres)
    : impl(&packing_shape.impl()),
      prefix(spheres != nullptr ? spheres : impl->prefix),
      world(impl->toWorld(body)),
      margin(packing_shape.getMargin()),
      slack(search_slack) {
  if (estimator != Estimator::volume_true || prefix->volume_true == nullptr) return;
  prefix = &impl->solid->prefix(prefix->volume_true->count);
  radii = prefix->volume_true->radii.data();
  excess = prefix->largest_bulge * scale();
}

Placement PackingBody::placement() const {
  Placement p;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) p.rotation[3 * i + j] = world.getBasis()[i][j];
    p.translation[i] = world.getOrigin()[i];
  }
  p.scale = scale();
  return p;
}

bool PackingBody::nearest(const btVector3& place, btScalar reach, SurfaceTree::Nearest& nearest) const {
  const btMatrix3x3& axes = world.getBasis();
  if (!impl->surfaceTree().nearest((place * axes) / scale(), reach / scale(), nearest)) return false;
  nearest.distance *= scale();
  nearest.normal = axes * nearest.normal;
  return true;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
