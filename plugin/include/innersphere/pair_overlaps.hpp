// What bodies in contact share and how they push each other, for haptics, sound and logging.
#pragma once

#include <vector>

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// A pair of bodies, or of children of compounds, that touch. Vectors have the axes of the world.
struct PairOverlap {
  const btCollisionObject* a = nullptr;  ///< has a packing
  const btCollisionObject* b = nullptr;  ///< the other one, of any shape
  /// That both share, by the spheres [m^3]. Of what is no packing a sphere sees the plane that touches it
  /// where it is nearest; one that lies all behind the triangles of a mesh or height field does not count.
  double volume = 0;
  btVector3 centroid{0, 0, 0};       ///< of that volume in the world [m]; of the contacts where there is none
  btVector3 area{0, 0, 0};           ///< of the contact times its direction, from A to B [m^2]
  btScalar depth = 0;                ///< of the deepest contact [m]; negative: the width of the gap
  btVector3 force{0, 0, 0};          ///< of all contacts on B in the last step, with damping and friction [N]
  btVector3 torque{0, 0, 0};         ///< of that force on B about `centroid` [N m]
  btVector3 penalty_force{0, 0, 0};  ///< Response::penalty: on B, without damping and friction [N]
  double penalty_energy = 0;         ///< Response::penalty: its potential [J]
  /// Response::penalty: a longer time step may be unstable [s]; 1e18 for the other responses, which are
  /// stable at any step.
  btScalar largest_step = BT_LARGE_FLOAT;
};

/// All pairs with contacts, as they were when the last step looked for them; forces are those that the solver
/// found then. In the order in which their boxes met. Costs a volume query for each pair, except with
/// Response::penalty, which knows its volumes. Throws Error bad_argument if PackingCollisionAlgorithm is not
/// registered with the dispatcher.
std::vector<PairOverlap> pairOverlaps(btDispatcher* dispatcher);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
