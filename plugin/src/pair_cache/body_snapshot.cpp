#include "pair_cache/body_snapshot.hpp"

#include <cmath>

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btTransformUtil.h>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

BodySnapshot::BodySnapshot(const btCollisionObject& object, btScalar time_step)
    : object_(&object),
      body_(btRigidBody::upcast(&object)),
      transform_(object.getWorldTransform()),
      velocity_(object),
      motion_(object, velocity_) {
  take(time_step);
}

BodySnapshot::BodySnapshot(const btCollisionObjectWrapper& wrapper, btScalar time_step)
    : BodySnapshot(*wrapper.getCollisionObject(), time_step) {
  shape_place_ = wrapper.getWorldTransform();
}

namespace {

/// What held a body in the last step, against forces that would have pushed it so: it goes on doing so.
btVector3 heldOf(const btVector3& pushed, const btVector3& sped_up) {
  const btScalar push2 = pushed.length2();
  if (!(push2 > 0)) return {0, 0, 0};
  return pushed * (1 - btMin(btScalar(1), btMax(btScalar(0), pushed.dot(sped_up) / push2)));
}

}  // namespace

void BodySnapshot::take(btScalar time_step) {
  way_.store(0, std::memory_order_relaxed);
  neighbours_.store(0, std::memory_order_relaxed);
  if (!hasSameShape()) {
    ++changes_;
    shape_ = object_->getCollisionShape();
    shape_type_ = shape_->getShapeType();
    packing_ = PackingShape::from(shape_);
  }
  if (packing_ != nullptr && version_ != packing_->impl().version) {
    ++changes_;
    version_ = packing_->impl().version;
  }
  active_ = object_->isActive();
  const btVector3 before = velocity_.linear, pushed = push_;
  velocity_ = BodyVelocity(*object_);
  push_ = pushIn(*object_, time_step);
  motion_ = Motion(*object_, velocity_, push_ - heldOf(pushed, velocity_.linear - before));
  const btTransform& now = object_->getWorldTransform();
  if (!(now == transform_)) travel_ += travelBetween(transform_, now, motion_.size);
  transform_ = start_ = now;
  if (velocity_.has_arrived)
    btTransformUtil::integrateTransform(now, -velocity_.linear, -velocity_.spin, time_step, start_);
}

bool BodySnapshot::hasFiniteSpeed() const {
  return std::isfinite(velocity_.linear.length2()) && std::isfinite(velocity_.spin.length2());
}

bool BodySnapshot::isAsTaken(const btCollisionObjectWrapper& wrapper) const {
  return wrapper.getCollisionObject() == object_ && wrapper.getCollisionShape() == shape_ &&
         isAsTaken(wrapper.getWorldTransform());
}

bool BodySnapshot::hasSameShape() const {
  return object_->getCollisionShape() == shape_ && shape_->getShapeType() == shape_type_;
}

bool BodySnapshot::isAsTaken(const btTransform& transform) const {
  return transform == transform_ && hasSameShape() &&
         (packing_ == nullptr || packing_->impl().version == version_) &&
         (body_ == nullptr ||
          (body_->getLinearVelocity() == velocity_.linear && body_->getAngularVelocity() == velocity_.spin));
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
