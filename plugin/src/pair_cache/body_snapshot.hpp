// Shows a body as it was at one moment.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>

#include "common/body_velocity.hpp"
#include "common/motion_bound.hpp"
#include "shape/packing_shape_impl.hpp"

class btRigidBody;

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Holds where a body is, how fast, how far it has travelled, and which shape it has.
class BodySnapshot {
 public:
  /// Takes a first snapshot of a body, in a step of `time_step` [s].
  BodySnapshot(const btCollisionObject& object, btScalar time_step);
  /// Takes one of the body of a shape that is where the wrapper says, whatever the body's own place.
  BodySnapshot(const btCollisionObjectWrapper& wrapper, btScalar time_step);

  /// Takes another one.
  void take(btScalar time_step);
  /// Returns true if the body, as Bullet asks for it, is as it was in the snapshot.
  bool isAsTaken(const btCollisionObjectWrapper& wrapper) const;
  /// Returns true if the body is where it was, and as fast; its shape may be a child of a compound.
  bool isAsTaken() const { return isAsTaken(object_->getWorldTransform()); }
  /// Notes that, for all pairs of the body.
  void compare() { changed_ = !isAsTaken(); }
  bool hasChanged() const { return changed_; }

  const btCollisionObject* object() const { return object_; }
  const btTransform& transform() const { return transform_; }
  /// Returns where the body was when the step began: Bullet has moved kinematic bodies, and no others yet.
  const btTransform& start() const { return start_; }
  /// Returns where something was then that is part of the body, and is here now.
  btTransform startOf(const btTransform& place) const {
    return velocity_.has_arrived ? start_ * transform_.inverse() * place : place;
  }
  /// Returns where the shape is, if that was said.
  const std::optional<btTransform>& shapePlace() const { return shape_place_; }
  const BodyVelocity& velocity() const { return velocity_; }
  const Motion& motion() const { return motion_; }
  /// Returns true if its speeds are finite, and their squares are, which all lengths are made of.
  bool hasFiniteSpeed() const;
  bool isActive() const { return active_; }
  /// Returns how often a snapshot has found another shape, or another packing in it.
  std::uint32_t changes() const { return changes_; }
  /// Returns a distance that no point of the body has exceeded since the first snapshot [m].
  double travel() const { return travel_; }
  /// Notes, by any thread, how much nearer a body comes that it may meet in the step [m].
  void noteWay(btScalar way) {
    btScalar known = way_.load(std::memory_order_relaxed);
    while (way > known && !way_.compare_exchange_weak(known, way, std::memory_order_relaxed)) {
    }
  }
  /// Returns the most that was noted since the snapshot was taken [m].
  btScalar way() const { return way_.load(std::memory_order_relaxed); }
  /// Notes, by any thread, that the body touched another one in the last step.
  void noteNeighbour() { neighbours_.fetch_add(1, std::memory_order_relaxed); }
  /// Returns how many were noted since the snapshot was taken.
  int neighbours() const { return neighbours_.load(std::memory_order_relaxed); }

  std::size_t users = 0;       ///< pairs
  std::size_t list_index = 0;  ///< see PairList

 private:
  bool isAsTaken(const btTransform& transform) const;
  /// Another shape may be at the same address.
  bool hasSameShape() const;

  const btCollisionObject* object_;
  const btRigidBody* body_;  ///< null if it is none
  const btCollisionShape* shape_ = nullptr;
  int shape_type_ = 0;
  const PackingShape* packing_ = nullptr;
  std::uint64_t version_ = 0;  ///< of the packing shape
  btTransform transform_, start_;
  std::optional<btTransform> shape_place_;
  BodyVelocity velocity_;
  btVector3 push_{0, 0, 0};  ///< what forces add to it in a step [m/s]
  Motion motion_;
  double travel_ = 0;
  bool active_ = true;
  bool changed_ = false;  ///< found by compare()
  std::uint32_t changes_ = 0;
  std::atomic<int> neighbours_ = 0;
  std::atomic<btScalar> way_ = 0;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
