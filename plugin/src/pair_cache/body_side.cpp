#include "pair_cache/body_side.hpp"

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>

#include "common/bullet_vectors.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
BodySide::BodySide(const btCollisionObjectWrapper& wrapper)
    : object(wrapper.getCollisionObject()),
      shape(wrapper.getCollisionShape()),
      transform(wrapper.getWorldTransform()) {
  for (const btCollisionObjectWrapper* w = &wrapper; w->m_parent != nullptr; w = w->m_parent) {
    if (nesting == kMaxNesting) {
      nesting = -1;
      return;
    }
    child_of[nesting++] = w->m_index;
  }
}

bool BodySide::refresh() {
  if (nesting < 0) return false;
  const btCollisionShape* at = object->getCollisionShape();
  transform = object->getWorldTransform();
  for (int level = nesting - 1; level >= 0; --level) {
    if (!at->isCompound()) return false;
    const auto& compound = static_cast<const btCompoundShape&>(*at);
    if (child_of[level] < 0 || child_of[level] >= compound.getNumChildShapes()) return false;
    transform = transform * compound.getChildTransform(child_of[level]);
    at = compound.getChildShape(child_of[level]);
  }
  return at == shape && isFinite(transform);
}

bool isActive(const BodySide& a, const BodySide& b) {
  return a.object->isActive() || b.object->isActive();
}

PackingSide::PackingSide(const btCollisionObjectWrapper& wrapper, const PackingShape& packing_shape)
    : BodySide(wrapper),
      packing(&packing_shape),
      margin(packing_shape.getMargin()),
      version(packing_shape.impl().version) {}

bool PackingSide::refresh() {
  if (!BodySide::refresh()) return false;
  margin = packing->getMargin();
  version = packing->impl().version;
  return true;
}

bool PackingSide::isAlike(const PackingSide& other) const {
  return object == other.object && packing == other.packing && version == other.version;
}

bool PackingSide::isUpToDate() const {
  return version == packing->impl().version;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
