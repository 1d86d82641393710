#include "narrow_phase/contact_settings.hpp"

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include "narrow_phase/contact_transport.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Whether contact points on the two sides of a solid are so close that Bullet would take them for one.
bool isThin(const PackingShape::Impl& shape) {
  return shape.halfThickness() < gContactBreakingThreshold * shape.size;
}

}  // namespace

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
  inset_a = (packing_b == nullptr ? prefix_a->feelers() : prefix_a->searchFeelers()).inset *
            a.getLocalScaling().x();
  search_margin_a = separation + inset_a;
  if (packing_b == nullptr) return;
  search_margin_b = prefix_b->searchFeelers().inset * b.getLocalScaling().x();
  thin = isThin(a.impl()) || isThin(packing_b->impl());
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
