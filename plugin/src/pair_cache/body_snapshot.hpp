// A body as it was at one moment.
#pragma once

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

class BodySnapshot {
 public:
  explicit BodySnapshot(const btCollisionObject& object);
  /// Of the body of a shape that is where the wrapper says, whatever the body's own place.
  explicit BodySnapshot(const btCollisionObjectWrapper& wrapper);

  /// Takes another one.
  void take();
  /// Whether the body, as Bullet asks for it, is as it was in the snapshot.
  bool isAsTaken(const btCollisionObjectWrapper& wrapper) const;
  /// The same, for where the body is and how fast: its shape may be a child of a compound.
  bool isAsTaken() const { return isAsTaken(object_->getWorldTransform()); }
  /// Notes that, for all pairs of the body.
  void compare() { changed_ = !isAsTaken(); }
  bool hasChanged() const { return changed_; }

  const btCollisionObject* object() const { return object_; }
  const btTransform& transform() const { return transform_; }
  /// Where the shape is, if that was said.
  const std::optional<btTransform>& shapePlace() const { return shape_place_; }
  const BodyVelocity& velocity() const { return velocity_; }
  const Motion& motion() const { return motion_; }
  bool isActive() const { return active_; }
  /// How often a snapshot has found another shape, or another packing in it.
  std::uint32_t changes() const { return changes_; }
  /// No point of the body has travelled further than this since the first snapshot [m].
  double travel() const { return travel_; }

  std::size_t users = 0;       ///< pairs
  std::size_t list_index = 0;  ///< see PairList

 private:
  bool isAsTaken(const btTransform& transform) const;

  const btCollisionObject* object_;
  const btRigidBody* body_;  ///< null if it is none
  const btCollisionShape* shape_ = nullptr;
  const PackingShape* packing_ = nullptr;
  std::uint64_t version_ = 0;  ///< of the packing shape
  btTransform transform_;
  std::optional<btTransform> shape_place_;
  BodyVelocity velocity_;
  Motion motion_;
  double travel_ = 0;
  bool active_ = true;
  bool changed_ = false;  ///< found by compare()
  std::uint32_t changes_ = 0;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
