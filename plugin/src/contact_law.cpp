#include "contact_law.hpp"

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Default stiffness in units of m / dt^2.
constexpr btScalar kStiffness = 64;
/// Contacts deeper than 0.04 m lose their spring to Bullet's split impulse by default; stay above.
constexpr btScalar kSplitImpulseDepth = btScalar(0.03);
/// The default law pushes no harder than at this depth, in units of the body's size, so that bodies which
/// start inside each other part at walking pace.
constexpr btScalar kDeepest = btScalar(0.02);

btScalar inverseMass(const btCollisionObject& object) {
  if (object.isStaticOrKinematicObject()) return 0;
  if (const btRigidBody* body = btRigidBody::upcast(&object)) return body->getInvMass();
  if (const btMultiBodyLinkCollider* collider = btMultiBodyLinkCollider::upcast(&object)) {
    const btMultiBody* body = collider->m_multiBody;
    if (collider->m_link < 0 && body->hasFixedBase()) return 0;
    const btScalar mass = collider->m_link < 0 ? body->getBaseMass() : body->getLinkMass(collider->m_link);
    return mass > 0 ? 1 / mass : btScalar(0);
  }
  return 0;
}

}  // namespace

ContactLaw::ContactLaw(const ContactOptions& options, btScalar reduced_mass, btScalar time_step,
                       btScalar size)
    : options_(options),
      mass_(reduced_mass > 0 ? reduced_mass : btScalar(1)),
      time_step_(time_step > 0 ? time_step : btScalar(1) / 60),
      deepest_(btMin(kSplitImpulseDepth, kDeepest * size)) {}

void ContactLaw::weigh(const std::vector<ContactPatch>& patches) {
  laws_.clear();
  if (options_.response == Response::rigid) return;
  for (const ContactPatch& patch : patches) {
    btScalar area = 0;
    for (const ContactPatch& other : patches)
      area += other.area * btMax(btScalar(0), patch.normal.dot(other.normal));
    const btScalar stiffness = options_.stiffness > 0 ? btScalar(options_.stiffness) * area
                                                      : kStiffness * mass_ / (time_step_ * time_step_);
    const btScalar damping = btScalar(options_.damping) * 2 * btSqrt(stiffness * mass_);
    const btScalar share = area > 0 ? patch.area / (area * btScalar(patch.count)) : btScalar(0);
    laws_.push_back({stiffness * share, damping * share});
  }
}

PointLaw ContactLaw::point(std::size_t index, btScalar depth) const {
  PointLaw law;
  law.depth = depth;
  if (options_.response == Response::rigid) return law;
  law.spring = true;
  law.stiffness = laws_[index].stiffness;
  law.damping = laws_[index].damping;
  if (options_.stiffness > 0) {
    // The same force from a smaller depth.
    if (depth > kSplitImpulseDepth) {
      law.stiffness *= depth / kSplitImpulseDepth;
      law.depth = kSplitImpulseDepth;
    }
  } else {
    law.depth = btMin(depth, deepest_);
  }
  return law;
}

btScalar reducedMass(const btCollisionObject& a, const btCollisionObject& b) {
  const btScalar inverse = inverseMass(a) + inverseMass(b);
  return inverse > 0 ? 1 / inverse : btScalar(0);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
