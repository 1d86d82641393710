#include "measure.hpp"

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include "packing_shape_impl.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

Measure::Measure(const ContactOptions& options, const PackingShape& a, const btCollisionShape& b,
                 btScalar separated)
    : spacing(btMin(a.getContactBreakingThreshold(gContactBreakingThreshold),
                    b.getContactBreakingThreshold(gContactBreakingThreshold))),
      separation(btMax(spacing, separated)) {
  const PackingShape* packing_b = PackingShape::from(&b);
  on_surfaces = options.stiffness == 0 && options.response != Response::penalty && a.impl().hasSurface() &&
                (packing_b == nullptr || packing_b->impl().hasSurface());
  if (!on_surfaces) {
    estimator = options.estimator;
    return;
  }
  slack_a = separation + a.impl().recess() * a.getLocalScaling().x();
  if (packing_b != nullptr) slack_b = packing_b->impl().recess() * b.getLocalScaling().x();
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
