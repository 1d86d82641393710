#include "response/impulse_body.hpp"

#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

PushedBody::PushedBody(const btCollisionObject& object, btScalar time_step)
    : centre_(object.getWorldTransform().getOrigin()), inverse_inertia_(0, 0, 0, 0, 0, 0, 0, 0, 0) {
  // Bullet hands out bodies to its algorithms as const, and its solver writes to them all the same.
  auto* body = const_cast<btRigidBody*>(btRigidBody::upcast(&object));
  if (body == nullptr) return;
  velocity_ = body->getLinearVelocity();
  spin_ = body->getAngularVelocity();
  if (body->isStaticOrKinematicObject() || body->getActivationState() == DISABLE_SIMULATION) return;
  body_ = body;
  inverse_mass_ = body->getInvMass() * body->getLinearFactor();
  for (int i = 0; i < 3; ++i)
    inverse_inertia_[i] = body->getInvInertiaTensorWorld()[i] * body->getAngularFactor()[i];
  velocity_ += body->getTotalForce() * body->getInvMass() * time_step;
  spin_ += inverse_inertia_ * body->getTotalTorque() * time_step;
}

btScalar PushedBody::inverseMassAt(const btVector3& point, const btVector3& direction) const {
  const btVector3 arm = (point - centre_).cross(direction);
  return direction.dot(inverse_mass_ * direction) + arm.dot(inverse_inertia_ * arm);
}

btScalar PushedBody::inverseInertiaAbout(const btVector3& direction) const {
  return direction.dot(inverse_inertia_ * direction);
}

btScalar PushedBody::largestInverseMass(btScalar distance) const {
  // The largest row sum bounds the largest eigenvalue.
  btScalar largest = 0;
  for (int i = 0; i < 3; ++i) {
    const btVector3 row = inverse_inertia_[i].absolute();
    largest = btMax(largest, row.x() + row.y() + row.z());
  }
  return inverse_mass_[inverse_mass_.maxAxis()] + distance * distance * largest;
}

void PushedBody::push(const btVector3& impulse, const btVector3& point) {
  push(impulse);
  turn((point - centre_).cross(impulse));
}

void PushedBody::push(const btVector3& impulse) {
  impulse_ += impulse;
  velocity_ += inverse_mass_ * impulse;
}

void PushedBody::turn(const btVector3& angular_impulse) {
  angular_impulse_ += angular_impulse;
  spin_ += inverse_inertia_ * angular_impulse;
}

void PushedBody::apply() const {
  if (body_ == nullptr) return;
  body_->applyCentralImpulse(impulse_);
  body_->applyTorqueImpulse(angular_impulse_);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
