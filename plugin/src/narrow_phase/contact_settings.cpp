#include "narrow_phase/contact_settings.hpp"

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include "narrow_phase/contact_transport.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

ContactSettings::ContactSettings(const ContactOptions& options, const PackingShape& a,
                                 const btCollisionShape& b, btScalar needed)
    : spacing(btMin(a.getContactBreakingThreshold(gContactBreakingThreshold),
                    b.getContactBreakingThreshold(gContactBreakingThreshold))),
      separation(btMax(spacing, needed + kSearchAgain * spacing)) {
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
  // Other packings do not see feelers.
  const btScalar inset = packing_b == nullptr ? prefix_a->feelers().inset : prefix_a->inset();
  inset_a = inset * a.getLocalScaling().x();
  search_margin_a = separation + inset_a;
  if (packing_b != nullptr) search_margin_b = prefix_b->inset() * b.getLocalScaling().x();
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
