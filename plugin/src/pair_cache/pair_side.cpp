#include "pair_cache/pair_side.hpp"

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>

#include "common/bullet_vectors.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

PairSide::PairSide(const btCollisionObjectWrapper& wrapper)
    : object(wrapper.getCollisionObject()),
      shape(wrapper.getCollisionShape()),
      shape_type(shape->getShapeType()),
      packing(PackingShape::from(shape)),
      transform(wrapper.getWorldTransform()),
      start(transform) {
  for (const btCollisionObjectWrapper* w = &wrapper; w->m_parent != nullptr; w = w->m_parent) {
    if (nesting == kMaxNesting) {
      nesting = -1;
      return;
    }
    child_of[nesting++] = w->m_index;
  }
}

std::optional<btTransform> PairSide::placeIn(const BodySnapshot& body) const {
  if (body.shapePlace()) return body.shapePlace();
  if (nesting < 0) return std::nullopt;
  const btCollisionShape* at = object->getCollisionShape();
  btTransform place = body.transform();
  for (int level = nesting - 1; level >= 0; --level) {
    if (!at->isCompound()) return std::nullopt;
    const auto& compound = static_cast<const btCompoundShape&>(*at);
    if (child_of[level] < 0 || child_of[level] >= compound.getNumChildShapes()) return std::nullopt;
    place = place * compound.getChildTransform(child_of[level]);
    at = compound.getChildShape(child_of[level]);
  }
  if (!holds(at) || !isFinite(place)) return std::nullopt;
  return place;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
