// Describes one side of a pair: a body, and the shape of it that takes part.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>

#include "pair_cache/body_snapshot.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Names a body and its shape, and says where that was.
struct PairSide {
  PairSide() = default;
  explicit PairSide(const btCollisionObjectWrapper& wrapper);

  /// Returns true if the shape is the body's own, and not a child of a compound.
  bool isWhole() const { return nesting == 0; }
  /// Returns where the shape is in a snapshot of its body. Returns nothing if that cannot be known: the body
  /// has another shape, is at NaN, or the compounds are nested too deeply. Does not read the shape: its owner
  /// may have freed it when he took it from the body, and Bullet says nothing of that.
  std::optional<btTransform> placeIn(const BodySnapshot& body) const;
  /// Returns true if the wrapper holds the same shape of the same body.
  bool isFor(const btCollisionObjectWrapper& wrapper) const {
    return object == wrapper.getCollisionObject() && holds(wrapper.getCollisionShape());
  }
  /// Returns true if the packing has not been changed since noteShape(), and for other shapes.
  bool hasSameShape() const { return packing == nullptr || packing->impl().version == version; }
  void noteShape() { version = packing == nullptr ? 0 : packing->impl().version; }

  /// Returns true for this shape, as far as its address and its kind tell; `other` is to live.
  bool holds(const btCollisionShape* other) const {
    return other == shape && other->getShapeType() == shape_type;
  }

  static constexpr int kMaxNesting = 4;

  const btCollisionObject* object = nullptr;
  const btCollisionShape* shape = nullptr;
  int shape_type = 0;
  const PackingShape* packing = nullptr;  ///< null for a shape of another kind
  std::uint64_t version = 0;              ///< of the packing, when contact was searched for last
  btTransform transform =
      btTransform::getIdentity();  ///< of the shape in the world, at the last update of the pair
  btTransform start =
      btTransform::getIdentity();           ///< the same where the step of that update began (BodySnapshot)
  int nesting = 0;                          ///< in how many compounds, -1 if too many
  std::array<int, kMaxNesting> child_of{};  ///< which child of them, innermost first
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
