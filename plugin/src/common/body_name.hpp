// Names bodies in messages.
#pragma once

#include <string>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Returns by which numbers a user can find a body, as "getWorldArrayIndex() 3 and getUserIndex() -1".
inline std::string numbersOf(const btCollisionObject& body) {
  return "getWorldArrayIndex() " + std::to_string(body.getWorldArrayIndex()) + " and getUserIndex() " +
         std::to_string(body.getUserIndex());
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
