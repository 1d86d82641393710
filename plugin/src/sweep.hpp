// How far bodies move towards each other in a step.
#pragma once

#include <LinearMath/btScalar.h>

#include "innersphere/bullet_precision.hpp"

class btCollisionObject;

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// An upper bound for how much nearer two points of the bodies can come in `time_step` at the present
/// velocities [m], at most half the size of the smaller body. Contacts that far apart are handed to the
/// solver already, which lets them close but not pass, so that a fast body does not go deep into another
/// before its first contact.
btScalar sweepOf(const btCollisionObject& a, const btCollisionObject& b, btScalar time_step);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
