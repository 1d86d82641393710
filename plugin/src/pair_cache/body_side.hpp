// One body of a pair, as Bullet asked for it last, and where it has gone since.
#pragma once

#include <array>

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>

#include "shape/packing_shape_impl.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

struct BodySide {
  explicit BodySide(const btCollisionObjectWrapper& wrapper);

  /// To where the body is now. False if that cannot be known: a changed shape, a body at NaN, a compound of
  /// compounds of compounds ...
  bool refresh();
  /// The same shape of the same body, where it was.
  bool isWhere(const BodySide& other) const {
    return object == other.object && shape == other.shape && transform == other.transform;
  }

  bool isWhere(const btCollisionObjectWrapper& wrapper) const {
    return object == wrapper.getCollisionObject() && shape == wrapper.getCollisionShape() &&
           transform == wrapper.getWorldTransform();
  }

  static constexpr int kMaxNesting = 4;

  const btCollisionObject* object;
  const btCollisionShape* shape;
  btTransform transform;
  int nesting = 0;                          ///< in how many compounds, -1 if too many
  std::array<int, kMaxNesting> child_of{};  ///< which child of them, innermost first
};

/// Bullet does not dispatch pairs of bodies that are both at rest.
bool isActive(const BodySide& a, const BodySide& b);

/// A body with a packing.
struct PackingSide : BodySide {
  PackingSide(const btCollisionObjectWrapper& wrapper, const PackingShape& packing_shape);

  bool refresh();
  /// The same but for where it is.
  bool isAlike(const PackingSide& other) const;
  /// As its shape is now.
  bool isUpToDate() const;

  const PackingShape* packing;
  btScalar margin;
  std::size_t version;  ///< of the shape: see PackingShape::Impl
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
