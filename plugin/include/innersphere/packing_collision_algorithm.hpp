// Adds the narrow phase for packings to a Bullet program, with one line.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/contact_options.hpp"

class btDynamicsWorld;

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Makes a dispatcher collide PackingShape with every other shape.
struct PackingCollisionAlgorithm {
  /// Does all that a world needs: registers with it, as registerAlgorithm(world, options) does, and sets
  /// SOLVER_USE_2_FRICTION_DIRECTIONS in its solver's mode, which is not among Bullet's defaults. Nothing
  /// else of the world is changed. Call it after btGImpactCollisionAlgorithm::registerAlgorithm; calling it
  /// again replaces the options.
  ///
  /// Without the second direction Bullet's solver has one row of friction for a point, along the way in which
  /// it slides before contacts push. Bodies that gravity moves alike do not slide then, whatever friction has
  /// to bear between them: the row lies where the last step's errors point, or along a fixed axis, and in
  /// such steps nothing holds them. A gripper on motors drops what it holds, an arch falls, piles creep; so
  /// do those of Bullet's hulls. No contact point can set that direction.
  ///
  /// Throws Error as registerAlgorithm does, and leaves the solver's mode then.
  static void prepareWorld(btDynamicsWorld& world, const ContactOptions& options = {});

  /// Registers for contact and closest-point queries against every shape type but compound and soft body,
  /// which Bullet itself walks down to their children. Call it after
  /// btGImpactCollisionAlgorithm::registerAlgorithm, which overwrites every row of its own. Calling it again
  /// replaces the options. `dispatcher` is a btCollisionDispatcher, or derived from it, as every dispatcher
  /// of Bullet's is.
  ///
  /// Contacts are written to the dispatcher's manifolds by all threads, when Bullet asks for the first pair
  /// of a step. Where the user has set a near-callback, or any of Bullet's global callbacks of contacts, they
  /// are written as Bullet asks for them, pair by pair and by the thread that asks, which takes longer. A
  /// dispatcher that collides pairs with a btManifoldResult of its own class must do so in a near-callback. A
  /// dispatcher may ask for several pairs at once, as btCollisionDispatcherMt does: they are processed in
  /// parallel, and bodies move the same, but that penalty forces act in the order in which it asks. Shapes
  /// are read by all threads, too; a concave shape of the user's own is asked for its triangles by one after
  /// the other.
  ///
  /// Throws Error: bad_argument (a null pointer, another kind of dispatcher, one without a collision
  /// configuration, a pool of algorithms whose elements are too small, options out of range), no_device
  /// (Backend::cuda without a device).
  static void registerAlgorithm(btDispatcher* dispatcher, const ContactOptions& options = {});
  /// Registers with the dispatcher of a world, as above. Contacts then follow the settings of its solver
  /// (btContactSolverInfo: warm starting, friction ERP, split impulse), as they are in each step; else they
  /// are made for Bullet's defaults, as they are after a registration of the dispatcher alone. The world must
  /// live as long as its dispatcher is used.
  ///
  /// Its solver's mode is left as it is: prepareWorld() sets what friction needs. If it is missing when
  /// bodies with friction touch first, the log says so, once for each registration.
  static void registerAlgorithm(btDynamicsWorld& world, const ContactOptions& options = {});

  /// Gives the dispatcher's entries for packings back to its collision configuration. What was kept for them
  /// (threads' buffers, on a device its memory and streams) is freed with the last pair that Bullet still has
  /// an algorithm for. Without it that happens at the end of the process, because a dispatcher does not tell
  /// when it goes: call it before a dispatcher is destroyed where worlds come and go. Does nothing for a
  /// dispatcher that is not registered.
  static void unregisterAlgorithm(btDispatcher* dispatcher);

  /// Drops what was kept for a dispatcher that is gone already, where nobody could call unregisterAlgorithm()
  /// in time: a world that belongs to another program, for example. The pointer is only compared, so it may
  /// dangle. Call it when the dispatcher's last pair is gone too, and before another dispatcher that may lie
  /// at the same address is registered: one that is still in use would be left with functions that are no
  /// more. Does nothing for an address that was never registered, or has been taken back.
  static void forget(const btDispatcher* gone) noexcept;

  /// Returns true if packings collide in the worlds of a dispatcher. Where a registration was forgotten,
  /// Bullet collides convex shapes with the triangles of a packing, as with a hollow mesh, and lets packings
  /// fall through each other, through planes and through meshes. The log names the packing when Bullet's
  /// narrow phase asks for its triangles first. Where it never does, the log says so within some hundred
  /// steps, but only if no dispatcher was ever registered in this process: Bullet does not tell which world a
  /// shape is in.
  static bool isRegistered(const btDispatcher* dispatcher);

  /// Returns the options that the dispatcher was registered with last. Throws Error bad_argument if it is not
  /// registered.
  static ContactOptions options(const btDispatcher* dispatcher);
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
