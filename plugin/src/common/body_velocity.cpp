#include "common/body_velocity.hpp"

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

BodyVelocity::BodyVelocity(const btCollisionObject& object) {
  if (const btRigidBody* body = btRigidBody::upcast(&object)) {
    linear = body->getLinearVelocity();
    spin = body->getAngularVelocity();
    has_arrived = body->isKinematicObject();
    return;
  }
  const btMultiBodyLinkCollider* collider = btMultiBodyLinkCollider::upcast(&object);
  if (collider == nullptr) return;
  // From joint to joint to the base. The links' own transforms in the world are those of the step before.
  const btMultiBody& body = *collider->m_multiBody;
  const btVector3& origin = object.getWorldTransform().getOrigin();
  btTransform frame = object.getWorldTransform();
  for (int i = collider->m_link; i >= 0; i = body.getLink(i).m_parent) {
    const btMultibodyLink& link = body.getLink(i);
    const btScalar* speeds = body.getVelocityVector() + 6 + link.m_dofOffset;
    for (int dof = 0; dof < link.m_dofCount; ++dof) {
      const btVector3 turning = frame.getBasis() * link.getAxisTop(dof) * speeds[dof];
      linear += frame.getBasis() * link.getAxisBottom(dof) * speeds[dof];
      linear += turning.cross(origin - frame.getOrigin());
      spin += turning;
    }
    frame *= btTransform(link.m_cachedRotParentToThis, -link.m_cachedRVector);
  }
  linear += body.getBaseVel() + body.getBaseOmega().cross(origin - frame.getOrigin());
  spin += body.getBaseOmega();
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
