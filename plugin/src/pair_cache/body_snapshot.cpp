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
      motion_(object, velocity_, 0) {
  take(time_step);
}

BodySnapshot::BodySnapshot(const btCollisionObjectWrapper& wrapper, btScalar time_step)
    : BodySnapshot(*wrapper.getCollisionObject(), time_step) {
  shape_place_ = wrapper.getWorldTransform();
}

void BodySnapshot::take(btScalar time_step) {
  way_.store(0, std::memory_order_relaxed);
  neighbours_.store(0, std::memory_order_relaxed);
  if (shape_ != object_->getCollisionShape()) {
    ++changes_;
    shape_ = object_->getCollisionShape();
    packing_ = PackingShape::from(shape_);
  }
  if (packing_ != nullptr && version_ != packing_->impl().version) {
    ++changes_;
    version_ = packing_->impl().version;
  }
  active_ = object_->isActive();
  velocity_ = BodyVelocity(*object_);
  motion_ = Motion(*object_, velocity_, time_step);
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

bool BodySnapshot::isAsTaken(const btTransform& transform) const {
  return transform == transform_ && object_->getCollisionShape() == shape_ &&
         (packing_ == nullptr || packing_->impl().version == version_) &&
         (body_ == nullptr ||
          (body_->getLinearVelocity() == velocity_.linear && body_->getAngularVelocity() == velocity_.spin));
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
