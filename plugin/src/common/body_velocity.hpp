// Finds how fast a body moves, whatever kind of body it is.
#pragma once

#include <LinearMath/btVector3.h>

#include "innersphere/bullet_precision.hpp"

class btCollisionObject;

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Holds the velocity of a rigid body or of a part of a multi-body. It is zero for any other body.
struct BodyVelocity {
  BodyVelocity() = default;
  explicit BodyVelocity(const btCollisionObject& object);

  btVector3 linear{0, 0, 0};  ///< of its origin [m/s]
  btVector3 spin{0, 0, 0};    ///< [rad/s]
  /// Bullet moves kinematic bodies before it looks for contact: they are where the step ends already.
  bool has_arrived = false;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
