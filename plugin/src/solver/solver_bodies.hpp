// Holds the bodies of a group while it is solved.
#pragma once

#include <vector>

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// What rows read and write of a body: how it moves, how far it has moved since the step began, and how it
/// yields to impulses.
struct BodyState {
  btVector3 velocity{0, 0, 0};  ///< [m/s]
  btVector3 spin{0, 0, 0};      ///< [rad/s]
  btVector3 moved{0, 0, 0};     ///< [m]
  btQuaternion turned = btQuaternion::getIdentity();
  btVector3 inverse_mass{0, 0, 0};  ///< along each axis of the world, as its linear factor allows [1/kg]
  /// Of the inverse inertia in the world, a symmetric matrix [1/(kg m^2)].
  btScalar xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  btVector3 inverseInertiaTimes(const btVector3& v) const {
    return btVector3(xx * v.x() + xy * v.y() + xz * v.z(), xy * v.x() + yy * v.y() + yz * v.z(),
                     xz * v.x() + yz * v.y() + zz * v.z());
  }
  void push(const btVector3& impulse, const btVector3& angular_impulse) {
    velocity += impulse * inverse_mass;
    spin += inverseInertiaTimes(angular_impulse);
  }
};

/// Bodies that can be moved come first; then the fixed world, and whatever else moves by itself.
class SolverBodies {
 public:
  /// Takes over the bodies of a group for a step of `time_step` [s], and gives each its place as companion
  /// id.
  void begin(btCollisionObject** objects, int count, btScalar time_step);
  /// Returns the place of a body: that of the fixed world for whatever stands still.
  int indexOf(const btCollisionObject& object);
  /// Notes that constraints read this body, so that it has to be where its state says.
  void follow(int index);

  int movable() const { return movable_; }
  bool isMovable(int index) const { return index < movable_; }
  std::vector<BodyState>& states() { return states_; }
  const std::vector<BodyState>& states() const { return states_; }
  const BodyState& state(int index) const { return states_[static_cast<std::size_t>(index)]; }
  /// Returns null for the fixed world.
  const btRigidBody* rigid(int index) const { return bodies_[static_cast<std::size_t>(index)].rigid; }
  btScalar mass(int index) const { return bodies_[static_cast<std::size_t>(index)].mass; }
  btScalar size(int index) const { return bodies_[static_cast<std::size_t>(index)].size; }
  /// Returns where the body was at the start of the step.
  const btVector3& origin(int index) const { return bodies_[static_cast<std::size_t>(index)].origin; }
  /// Returns where a point of the body that is here now was then: Bullet has moved kinematic bodies.
  btVector3 startOf(int index, const btVector3& point) const;
  /// Returns the largest acceleration that forces of the world and the user give a body [m/s^2].
  btScalar largestAcceleration() const;

  /// Adds what forces and torques bring in a substep [s] to the bodies in [begin, end).
  void accelerate(int begin, int end, btScalar substep);
  /// Moves the bodies in [begin, end).
  void move(int begin, int end, btScalar substep);
  /// What moves by itself goes on, as far as contacts and constraints see it.
  void moveDriven(btScalar substep);

  /// Writes poses and velocities such that Bullet's own integration over the step ends where the substeps
  /// did. Returns the number of bodies that have got lost in infinity: they keep their places and stop.
  int finish();
  /// Returns the number of bodies that came with infinite or undefined velocities, forces or places: they
  /// are stopped, and nothing touches them. What moves by itself counts once for each that asks for it.
  int broken() const { return static_cast<int>(broken_.size()) + broken_driven_; }
  static constexpr int kBroken = -1;  ///< the place of one of them

 private:
  struct Body {
    btRigidBody* rigid = nullptr;
    btVector3 force{0, 0, 0};                             ///< as an acceleration [m/s^2]
    btVector3 torque{0, 0, 0};                            ///< [N m]
    btTransform given;                                    ///< of what moves by itself: where it is put again
    btVector3 origin{0, 0, 0};                            ///< at the start
    btQuaternion rotation = btQuaternion::getIdentity();  ///< at the start
    btVector3 inverse_inertia{0, 0, 0};                   ///< about its own axes
    btVector3 inertia{0, 0, 0};
    btVector3 angular_factor{1, 1, 1};
    btScalar mass = 0;
    btScalar size = 0;
    bool tumbles = false;   ///< gyroscopic torque acts on it
    bool followed = false;  ///< constraints read it
  };
  void add(btRigidBody& rigid);
  void turn(const Body& body, BodyState& state, btScalar substep) const;
  void updateInertia(const Body& body, BodyState& state) const;
  btTransform poseOf(const Body& body, const BodyState& state) const;

  btScalar time_step_ = 0;
  std::vector<BodyState> states_;
  std::vector<Body> bodies_;
  int movable_ = 0;
  std::vector<btRigidBody*> broken_;
  int broken_driven_ = 0;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
