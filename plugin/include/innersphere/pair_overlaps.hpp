// Tells what bodies in contact share and how they push each other, for haptics, sound and logging.
#pragma once

#include <vector>

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Describes a pair of bodies, or of children of compounds, that touch. Vectors have the axes of the world.
struct PairOverlap {
  /// The body with the packing; the first of two packings.
  const btCollisionObject* a = nullptr;
  /// The other body, of any shape.
  const btCollisionObject* b = nullptr;
  /// The volume that both share, by the spheres [m^3]. Of what is no packing a sphere sees the plane that
  /// touches it where it is nearest; one that lies all behind the triangles of a mesh or height field does
  /// not count.
  double volume = 0;
  /// The centroid of that volume in the world [m]; the mean of the contact points where there is none.
  btVector3 centroid{0, 0, 0};
  /// The area of the contact times its direction, from A to B [m^2].
  btVector3 area{0, 0, 0};
  /// The depth of the deepest contact [m]; if negative, the width of the gap.
  btScalar depth = 0;
  /// The force of all contacts on B in the last step, with damping and friction [N].
  btVector3 force{0, 0, 0};
  /// The torque of that force on B about `centroid` [N m].
  btVector3 torque{0, 0, 0};
  /// The penalty force on B without damping and friction [N]; zero for responses but Response::penalty.
  btVector3 penalty_force{0, 0, 0};
  /// The potential of `penalty_force` [J].
  double penalty_energy = 0;
  /// The time step [s] beyond which Response::penalty may be unstable. BT_LARGE_FLOAT for the other
  /// responses, which are stable at any step.
  btScalar largest_step = BT_LARGE_FLOAT;
};

/// Returns all pairs with contacts, as they were when the last step looked for them; forces are those that
/// the solver found then. They come in the order in which their boxes met. It costs a volume query for each
/// pair, except with Response::penalty, which knows its volumes. Throws Error bad_argument if
/// PackingCollisionAlgorithm is not registered with the dispatcher, and what QueryContext::run() throws.
std::vector<PairOverlap> pairOverlaps(btDispatcher* dispatcher);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
