// Bounds how far bodies can move in a step, and have moved.
#pragma once

#include <limits>

#include <LinearMath/btTransform.h>

#include "common/body_velocity.hpp"
#include "innersphere/bullet_precision.hpp"

class btCollisionObject;

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Returns the acceleration that forces and gravity give a body [m/s^2]. Outside of a step there are none.
btVector3 accelerationOf(const btCollisionObject& object);
/// Says what the user's forces add to the velocity of a body in a step of `time_step` [s]: all but gravity,
/// with which all fall alike.
btVector3 pushIn(const btCollisionObject& object, btScalar time_step);

/// Tells how fast the points of a body move.
struct Motion {
  /// `push` is what its velocity may change by within the step [m/s].
  Motion(const btCollisionObject& object, const BodyVelocity& velocity_now,
         const btVector3& push = btVector3(0, 0, 0));

  btVector3 velocity{0, 0, 0};  ///< of its origin [m/s]
  btScalar rim_speed = 0;       ///< by turning [m/s]
  btScalar size = 0;            ///< no point is further from its origin [m]; BT_LARGE_FLOAT: it is infinite
  /// The body is swept if it moves by more than this in a step [m]; infinity: it never is.
  btScalar swept_from = std::numeric_limits<btScalar>::infinity();
};

/// Returns true if the bodies move so fast against each other that contact has to be looked for all along the
/// step: further than the motion threshold of Bullet's continuous collision detection, if one of them has it.
bool isSwept(const Motion& a, const Motion& b, btScalar time_step);

/// Returns an upper bound for how much nearer two points of the bodies can come in `time_step` at the present
/// velocities [m], at most the size of the smaller body unless they are swept: what is further away is met in
/// another pose. Contacts that far apart are handed to the solver already, which lets them close but not
/// pass, so that a fast body does not go deep into another before its first contact.
btScalar speculativeDistance(const Motion& a, const Motion& b, btScalar time_step);

/// Returns an upper bound for how far any point of a body of this size has moved [m].
btScalar travelBetween(const btTransform& before, const btTransform& now, btScalar size);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
