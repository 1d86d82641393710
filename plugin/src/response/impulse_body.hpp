// Shows a body as impulses see it.
#pragma once

#include <LinearMath/btMatrix3x3.h>

#include "innersphere/bullet_precision.hpp"

class btCollisionObject;
class btRigidBody;

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Collects impulses in one step, and gives them to the body at the end. Static and kinematic bodies only
/// have a velocity.
class PushedBody {
 public:
  /// Takes the body with the velocity that it will have at the end of a step without contacts: gravity and
  /// the user's forces are in it.
  PushedBody(const btCollisionObject& object, btScalar time_step);

  const btVector3& centre() const { return centre_; }
  const btVector3& spin() const { return spin_; }
  btVector3 velocityAt(const btVector3& point) const { return velocity_ + spin_.cross(point - centre_); }
  /// Returns the change of the velocity at a point along a unit vector, for a unit impulse there [1/kg].
  btScalar inverseMassAt(const btVector3& point, const btVector3& direction) const;
  /// Returns the change of its spin about a unit vector, for a unit angular impulse [1/(kg m^2)].
  btScalar inverseInertiaAbout(const btVector3& direction) const;
  /// Returns an upper bound of inverseMassAt() for a push in any direction at a point this far from the
  /// centre [1/kg].
  btScalar largestInverseMass(btScalar distance) const;

  /// Pushes it at a point of the world [N s].
  void push(const btVector3& impulse, const btVector3& point);
  /// Pushes it through the centre [N s].
  void push(const btVector3& impulse);
  /// Turns it by an angular impulse [N m s].
  void turn(const btVector3& angular_impulse);

  /// Adds everything that was collected to the velocity of the body itself.
  void apply() const;

 private:
  btRigidBody* body_ = nullptr;  ///< null if nothing moves it
  btVector3 centre_;
  btVector3 inverse_mass_{0, 0, 0};
  btMatrix3x3 inverse_inertia_;  ///< of the world's axes; rows are scaled by the body's angular factor
  btVector3 velocity_{0, 0, 0};
  btVector3 spin_{0, 0, 0};
  btVector3 impulse_{0, 0, 0};
  btVector3 angular_impulse_{0, 0, 0};
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
