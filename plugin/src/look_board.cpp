#include "look_board.hpp"

#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

SeenBody::SeenBody(const btCollisionObject& object) : object_(&object), body_(btRigidBody::upcast(&object)) {
  see();
}

void SeenBody::see() {
  if (shape_ != object_->getCollisionShape()) {
    shape_ = object_->getCollisionShape();
    packing_ = PackingShape::from(shape_);
  }
  if (packing_ != nullptr) version_ = packing_->impl().version;
  transform_ = object_->getWorldTransform();
  if (body_ == nullptr) return;
  velocity_ = body_->getLinearVelocity();
  spin_ = body_->getAngularVelocity();
}

bool SeenBody::isAsSeen(const btCollisionObjectWrapper& wrapper) const {
  return wrapper.getCollisionObject() == object_ && wrapper.getCollisionShape() == shape_ &&
         wrapper.getWorldTransform() == transform_ &&
         (packing_ == nullptr || packing_->impl().version == version_) &&
         (body_ == nullptr ||
          (body_->getLinearVelocity() == velocity_ && body_->getAngularVelocity() == spin_));
}

Look* LookBoard::add(const BodySide& a, const BodySide& b) {
  if (unused_.empty()) {
    unused_.push_back(&looks_.emplace_back());
    unused_.reserve(looks_.size());
  }
  Look* look = unused_.back();
  unused_.pop_back();
  look->a = use(a);
  look->b = use(b);
  return look;
}

void LookBoard::remove(Look* look) {
  release(look->a);
  release(look->b);
  *look = Look();
  unused_.push_back(look);
}

const SeenBody* LookBoard::use(const BodySide& side) {
  if (side.nesting != 0) return nullptr;
  SeenBody& body = bodies_.try_emplace(side.object, *side.object).first->second;
  ++body.users;
  return &body;
}

void LookBoard::release(const SeenBody* body) {
  if (body != nullptr && --bodies_.at(body->object()).users == 0) bodies_.erase(body->object());
}

bool LookBoard::isDone(Look& look, const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
                       btScalar time_step, const void* algorithm) {
  const std::lock_guard<std::mutex> lock(mutex_);
  fetchAhead(look, algorithm);
  if (!look.received || !isFresh(look) || time_step != time_step_ || look.a == nullptr || look.b == nullptr ||
      !look.a->isAsSeen(a) || !look.b->isAsSeen(b))
    return false;
  ask(look);
  return true;
}

/// Bullet asks for pairs in nearly the same order in each step, which is not that of their places in memory.
void LookBoard::fetchAhead(Look& look, const void* algorithm) {
  __builtin_prefetch(look.ahead, 1);
  __builtin_prefetch(look.algorithm_ahead);
  if (Look* before = asked_[next_]) {
    before->ahead = &look;
    before->algorithm_ahead = algorithm;
  }
  asked_[next_] = &look;
  next_ = (next_ + 1) % asked_.size();
}

void LookBoard::begin(btScalar time_step) {
  ++number_;
  time_step_ = time_step;
  for (auto& [object, body] : bodies_) body.see();
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
