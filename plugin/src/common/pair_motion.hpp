// Says how the two bodies of a pair move against each other.
#pragma once

#include "common/body_velocity.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Holds their velocities at one moment: the contacts of a pair are written with the same velocities,
/// whatever else is done to the bodies meanwhile.
class PairMotion {
 public:
  /// Both are at rest.
  PairMotion() = default;
  /// `swept` says that contact is looked for all along the step.
  PairMotion(const btVector3& origin_a, const BodyVelocity& a, const btVector3& origin_b,
             const BodyVelocity& b, bool swept = false)
      : origin_a_(origin_a), origin_b_(origin_b), a_(a), b_(b), swept_(swept) {}

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
  /// Returns true if the bodies are so fast that contact is looked for all along the step.
  bool isSwept() const { return swept_; }
  const BodyVelocity& a() const { return a_; }
  const BodyVelocity& b() const { return b_; }
  const btVector3& originA() const { return origin_a_; }
  const btVector3& originB() const { return origin_b_; }
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

  btVector3 origin_a_{0, 0, 0}, origin_b_{0, 0, 0};
  BodyVelocity a_, b_;
  bool swept_ = false;
};

/// Says what the step that contacts are for will bring, as far as the bodies' velocities tell.
struct StepAhead {
  /// How the bodies move, with places relative to the origin of A's packing.
  PairMotion motion;
  /// How long the step is [s]. 0: there is none, as in a query for closest points.
  btScalar time_step = 0;
  /// Surfaces that are this far apart might meet in the step [m].
  btScalar needed = 0;
  /// The size of the smaller body [m].
  btScalar size = 0;
  /// How deep either body lies in what it rests on [m].
  btScalar sunk = 0;

  /// Returns how deep two points of the surfaces, `depth` [m] deep in each other along `normal` (from A to B)
  /// at `place`, would be at the end of the step if nothing stopped the bodies.
  btScalar depthAtEnd(const btVector3& place, const btVector3& normal, btScalar depth) const {
    return depth + time_step * (motion.approachAt(place, normal) +
                                time_step / 2 * motion.approachByTurningAt(place, normal));
  }
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
