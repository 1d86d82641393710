#include "pair_cache/look_board.hpp"

#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

SeenBody::SeenBody(const btCollisionObject& object)
    : object_(&object),
      body_(btRigidBody::upcast(&object)),
      transform_(object.getWorldTransform()),
      motion_(object) {
  see();
}

void SeenBody::see() {
  still_ = true;
  changed_ = shape_ != object_->getCollisionShape();
  if (changed_) {
    shape_ = object_->getCollisionShape();
    packing_ = PackingShape::from(shape_);
  }
  if (packing_ != nullptr) {
    changed_ = changed_ || version_ != packing_->impl().version;
    version_ = packing_->impl().version;
  }
  active_ = object_->isActive();
  motion_ = Motion(*object_);
  const btTransform& now = object_->getWorldTransform();
  if (!(now == transform_)) way_ += wayOf(transform_, now, motion_.size);
  transform_ = now;
  if (body_ == nullptr) return;
  velocity_ = body_->getLinearVelocity();
  spin_ = body_->getAngularVelocity();
}

bool SeenBody::isAsSeen(const btCollisionObjectWrapper& wrapper) const {
  return wrapper.getCollisionObject() == object_ && wrapper.getCollisionShape() == shape_ &&
         isAsSeen(wrapper.getWorldTransform());
}

void SeenBody::check() {
  still_ = object_->getCollisionShape() == shape_ && isAsSeen(object_->getWorldTransform());
}

bool SeenBody::isAsSeen(const btTransform& transform) const {
  return transform == transform_ && (packing_ == nullptr || packing_->impl().version == version_) &&
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
  if (body.users++ == 0) seen_.add(&body);
  return &body;
}

void LookBoard::release(const SeenBody* body) {
  if (body == nullptr) return;
  SeenBody& used = bodies_.at(body->object());
  if (--used.users > 0) return;
  seen_.remove(&used);
  bodies_.erase(body->object());
}

bool LookBoard::isDone(Look& look, const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
                       btScalar time_step, const void* algorithm) {
  const std::lock_guard<std::mutex> lock(mutex_);
  fetchAhead(look, algorithm);
  if (!hasDelivered(look, time_step) || !look.a->isAsSeen(a) || !look.b->isAsSeen(b)) return false;
  ask(look);
  return true;
}

void LookBoard::check() {
  seen_.forEachInParallel([](SeenBody& body) { body.check(); });
}

bool LookBoard::isDone(const Look& look, btScalar time_step) const {
  return hasDelivered(look, time_step) && look.a->isStill() && look.b->isStill();
}

bool LookBoard::hasDelivered(const Look& look, btScalar time_step) const {
  return look.received && isFresh(look) && time_step == time_step_ && look.a != nullptr && look.b != nullptr;
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

void LookBoard::calm(Look& look, btScalar leeway, btScalar within) const {
  look.calm = look.a != nullptr && look.b != nullptr && leeway > 0;
  if (!look.calm) return;
  look.calm_to = look.a->way() + look.b->way() + leeway;
  look.calm_within = within;
}

bool LookBoard::staysCalm(Look& look) const {
  if (!look.calm) return false;
  const SeenBody &a = *look.a, &b = *look.b;
  look.calm = (a.isActive() || b.isActive()) && !a.hasChanged() && !b.hasChanged() &&
              a.way() + b.way() <= look.calm_to &&
              sweepOf(a.motion(), b.motion(), time_step_) <= look.calm_within;
  if (look.calm) look.wanted = false;
  return look.calm;
}

void LookBoard::follow(const Look& look, BodySide& a, BodySide& b) {
  if (!look.calm) return;
  a.transform = look.a->transform();
  b.transform = look.b->transform();
}

void LookBoard::begin(btScalar time_step) {
  ++number_;
  time_step_ = time_step;
  seen_.forEachInParallel([](SeenBody& body) { body.see(); });
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
