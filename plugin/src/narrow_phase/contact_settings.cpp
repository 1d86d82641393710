#include "narrow_phase/contact_settings.hpp"

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include "narrow_phase/contact_transport.hpp"
#include "response/option_rules.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

Measure::Measure(const ContactOptions& world_options, const PackingShape& a, const btCollisionShape& b,
                 btScalar needed)
    : spacing(btMin(a.getContactBreakingThreshold(gContactBreakingThreshold),
                    b.getContactBreakingThreshold(gContactBreakingThreshold))),
      separation(btMax(spacing, needed + ContactMemory::reserve(spacing))) {
  const ContactOptions options = optionsOfPair(world_options, a, b);
  const PackingShape* packing_b = PackingShape::from(&b);
  on_surfaces = options.stiffness == 0 && options.response != Response::penalty && a.impl().hasSurface() &&
                (packing_b == nullptr || packing_b->impl().hasSurface());
  // The gaps of both bodies add up.
  const btScalar accuracy = btScalar(options.accuracy) / (packing_b == nullptr ? 1 : 2);
  prefix_a = &a.impl().prefixFor(accuracy);
  if (packing_b != nullptr) prefix_b = &packing_b->impl().prefixFor(accuracy);
  if (!on_surfaces) {
    estimator = options.estimator;
    return;
  }
  slack_a = separation + prefix_a->recess() * a.getLocalScaling().x();
  if (packing_b != nullptr) slack_b = prefix_b->recess() * b.getLocalScaling().x();
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
