// Pushes bodies by penalty forces: impulses, past Bullet's solver.
#pragma once

#include <vector>

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include "innersphere/contact_options.hpp"
#include "innersphere/overlap.hpp"
#include "response/impulse_body.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Tells what was done to a pair of bodies in a step.
struct PenaltyReport {
  btVector3 force{0, 0, 0};                ///< on B, without damping and friction [N]
  double energy = 0;                       ///< potential of that force [J]
  btScalar largest_step = BT_LARGE_FLOAT;  ///< a longer time step may be unstable [s]
};

/// The force stiffness * sum V n on the lenses of an overlap has a potential. Given as an impulse F dt before
/// the velocities move the bodies (symplectic Euler), it keeps the energy for any time; steps must be shorter
/// than 2 / sqrt(K w), K = stiffness * sum pi a^2, w the inverse mass that the bodies have at the contact.
///
/// Damping, friction, rolling and spinning friction act at the points of the manifolds, each of which carries
/// its stiffness and depth: implicit, so they only ever take energy, and bounded by what the points push.
/// Restitution e, where both bodies have one, sets the damping: a linear spring with the fraction
/// -ln e / sqrt(pi^2 + ln^2 e) of critical damping returns the speed e.
class Penalty {
 public:
  Penalty(const btCollisionObject& a, const btCollisionObject& b, btScalar damping, btScalar time_step)
      : a_(a, time_step), b_(b, time_step), damping_(damping), time_step_(time_step) {}

  /// Returns true if both bodies take impulses, or stand still; links of a btMultiBody do not.
  static bool applies(const btCollisionObject& a, const btCollisionObject& b);

  /// Pushes the bodies. `stiffness` is in N/m^3. `arm` is the place in the world that overlap.torque is
  /// about. `manifolds` hold the points of this overlap, A first; they are told their impulses.
  PenaltyReport push(const Overlap& overlap, btScalar stiffness, const btVector3& arm,
                     const btManifoldArray& manifolds);

 private:
  struct Row;
  void solve(std::vector<Row>& rows);
  void resistRolling(Row& row, btScalar normal);

  PushedBody a_;
  PushedBody b_;
  btScalar damping_;
  btScalar time_step_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
