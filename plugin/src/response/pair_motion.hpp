// Says how the two bodies of a pair move against each other.
#pragma once

#include "common/body_velocity.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Holds their velocities at one moment: the contacts of a pair are written with the same velocities,
/// whatever else is done to the bodies meanwhile.
class PairMotion {
 public:
  PairMotion(const btVector3& origin_a, const BodyVelocity& a, const btVector3& origin_b,
             const BodyVelocity& b)
      : origin_a_(origin_a), origin_b_(origin_b), a_(a), b_(b) {}

  /// Returns the velocity of A as seen from B, at a point of the world [m/s].
  btVector3 velocityAt(const btVector3& point) const {
    return velocity(a_, origin_a_, point) - velocity(b_, origin_b_, point);
  }
  /// Returns the angular velocity of A as seen from B [rad/s].
  btVector3 spin() const { return a_.spin - b_.spin; }
  /// Returns the speed at which the bodies approach each other at a point of the world along `normal`, from A
  /// to B [m/s].
  btScalar approachAt(const btVector3& point, const btVector3& normal) const {
    return velocityAt(point).dot(normal);
  }
  /// Returns the acceleration with which their turning brings the bodies nearer there [m/s^2].
  btScalar approachByTurningAt(const btVector3& point, const btVector3& normal) const {
    return (centripetal(a_, origin_a_, point) - centripetal(b_, origin_b_, point)).dot(normal);
  }

 private:
  static btVector3 velocity(const BodyVelocity& body, const btVector3& origin, const btVector3& point) {
    return body.linear + body.spin.cross(point - origin);
  }
  static btVector3 centripetal(const BodyVelocity& body, const btVector3& origin, const btVector3& point) {
    return body.spin.cross(body.spin.cross(point - origin));
  }

  btVector3 origin_a_, origin_b_;
  BodyVelocity a_, b_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
