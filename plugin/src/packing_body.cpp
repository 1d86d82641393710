#include "packing_body.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

PackingBody::PackingBody(const PackingShape& packing_shape, const btTransform& body, Estimator estimator,
                         btScalar search_slack)
    : impl(&packing_shape.impl()),
      world(impl->toWorld(body)),
      radii(estimator == Estimator::volume_true ? impl->volume_true : nullptr),
      margin(packing_shape.getMargin()),
      slack(search_slack),
      excess(radii != nullptr ? impl->largest_bulge * impl->scaling.x() : btScalar(0)) {}

Placement PackingBody::placement() const {
  Placement p;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) p.rotation[3 * i + j] = world.getBasis()[i][j];
    p.translation[i] = world.getOrigin()[i];
  }
  p.scale = scale();
  return p;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
