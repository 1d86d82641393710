// Holds the bodies of a group while it is solved.
#pragma once

#include <atomic>
#include <vector>

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "innersphere/bullet_precision.hpp"
#include "solver/driven_bodies.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// A vector without the fourth number that Bullet's have.
struct PlainVector {
  btScalar x = 0, y = 0, z = 0;

  PlainVector& operator=(const btVector3& v) {
    x = v.x();
    y = v.y();
    z = v.z();
    return *this;
  }
  operator btVector3() const { return btVector3(x, y, z); }
};

/// What rows read and write of a body: how it moves, how far it has moved since the step began, and how it
/// yields to impulses. What passes write has lines of the caches of its own: the others' stay with all
/// threads.
struct alignas(64) BodyState {
  btVector3 velocity{0, 0, 0};  ///< [m/s]
  btVector3 spin{0, 0, 0};      ///< [rad/s]
  /// What contacts have borne in the last substep, with which the next one begins.
  btVector3 impulse{0, 0, 0};          ///< [N s]
  btVector3 angular_impulse{0, 0, 0};  ///< [N m s]
  btQuaternion turned = btQuaternion::getIdentity();
  PlainVector moved;         ///< [m]
  PlainVector inverse_mass;  ///< along each axis of the world, as its linear factor allows [1/kg]
  /// Of the inverse inertia in the world, a symmetric matrix [1/(kg m^2)].
  btScalar xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  btVector3 inverseInertiaTimes(const btVector3& v) const {
    return btVector3(xx * v.x() + xy * v.y() + xz * v.z(), xy * v.x() + yy * v.y() + yz * v.z(),
                     xz * v.x() + yz * v.y() + zz * v.z());
  }
  void push(const btVector3& by, const btVector3& turning_by) {
    velocity += by * inverse_mass;
    spin += inverseInertiaTimes(turning_by);
  }
};
static_assert(sizeof(BodyState) == 32 * sizeof(btScalar), "LaneBodies takes it in rows");

/// Bodies that can be moved come first; then the fixed world, and whatever else moves by itself.
class SolverBodies {
 public:
  // These four in turn, two of them for parts of the whole.
  /// Begins with so many objects, for a step of `time_step` [s].
  void begin(int count, btScalar time_step);
  /// Finds the bodies that can be moved of the objects in [begin, end).
  void find(int begin, int end, btCollisionObject** objects);
  /// Gives each of them a place.
  void collect();
  /// Takes over the bodies at the places in [begin, end), and tells each its place by its companion id.
  void fill(int begin, int end);
  /// Returns the place of a body that can be moved, or kBroken, or kOther for all others.
  int placeOf(const btCollisionObject& object) const;
  /// Returns the place of any body: that of the fixed world for whatever stands still.
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
  /// Returns 0 for what cannot be moved, and takes no account of its linear factor [1/kg].
  btScalar inverseMass(int index) const {
    return isMovable(index) ? rigid(index)->getInvMass() : btScalar(0);
  }
  btScalar size(int index) const { return bodies_[static_cast<std::size_t>(index)].size; }
  /// Returns where the body was at the start of the step.
  const btVector3& origin(int index) const { return bodies_[static_cast<std::size_t>(index)].origin; }
  /// Returns where a point of the body that is here now was then: Bullet has moved kinematic bodies.
  btVector3 startOf(int index, const btVector3& point) const;
  /// Returns the acceleration that forces of the world and the user give a body [m/s^2].
  const btVector3& acceleration(int index) const { return bodies_[static_cast<std::size_t>(index)].force; }
  /// Returns the largest acceleration that forces of the world and the user give a body [m/s^2].
  btScalar largestAcceleration() const;

  /// Adds what forces, torques and the impulses of the last substep bring in a substep [s] to the bodies in
  /// [begin, end).
  void accelerate(int begin, int end, btScalar substep);
  /// Moves the bodies in [begin, end).
  void move(int begin, int end, btScalar substep);
  /// What moves by itself has the velocities of the first of the substeps [s], and then goes on, as far as
  /// contacts and constraints see it.
  void startDriven(btScalar substep);
  void moveDriven(btScalar substep);

  /// Writes poses and velocities of the bodies in [begin, end) such that Bullet's own integration over the
  /// step ends where the substeps did. Bodies that have got lost in infinity keep their places and stop.
  void finish(int begin, int end);
  /// Puts what moves by itself where it was found.
  void release();
  /// All groups of a step are done.
  void endStep() { driven_bodies_.endStep(); }
  /// Returns the first body that came with infinite or undefined velocities, forces or places, or has got
  /// lost; null if there is none. Such bodies are stopped, and nothing touches the former.
  const btRigidBody* broken() const;
  static constexpr int kBroken = -1, kOther = -2;

 private:
  struct Body {
    btRigidBody* rigid = nullptr;
    btVector3 force{0, 0, 0};                             ///< as an acceleration [m/s^2]
    btVector3 torque{0, 0, 0};                            ///< [N m]
    btTransform given = btTransform::getIdentity();       ///< of what moves by itself: where it is put again
    btVector3 origin{0, 0, 0};                            ///< at the start
    btQuaternion rotation = btQuaternion::getIdentity();  ///< at the start
    btVector3 inverse_inertia{0, 0, 0};                   ///< about its own axes
    btVector3 inertia{0, 0, 0};
    btVector3 angular_factor{1, 1, 1};
    btScalar mass = 0;
    btScalar size = 0;
    bool broken = false;
    bool tumbles = false;   ///< gyroscopic torque acts on it
    bool round = false;     ///< its inertia is the same about any axis
    bool followed = false;  ///< constraints read it
  };
  static void fill(Body& body, BodyState& state);
  void turn(const Body& body, BodyState& state, btScalar substep) const;
  static void updateInertia(const Body& body, BodyState& state);
  btTransform poseOf(const Body& body, const BodyState& state) const;
  /// Calls visit(body, state, motion) for each body that moves by itself.
  template <typename Visit>
  void forEachDriven(const Visit& visit);

  btScalar time_step_ = 0;
  std::vector<BodyState> states_;
  std::vector<Body> bodies_;
  std::vector<DrivenMotion> motions_;  ///< of the bodies after the fixed world
  DrivenBodies driven_bodies_;
  std::vector<btRigidBody*> found_;  ///< for each object; null: it cannot be moved
  int movable_ = 0;
  std::atomic<bool> broken_{false};
  const btRigidBody* broken_driven_ = nullptr;  ///< what moves by itself, and has no place among the bodies
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
