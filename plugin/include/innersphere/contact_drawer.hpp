// Draws contacts, overlaps and spheres with Bullet's debug drawer.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletDynamics/Dynamics/btActionInterface.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Says what a ContactDrawer draws.
struct ContactDrawerOptions {
  /// Whether the points of each patch of contact are joined by blue lines.
  bool patches = true;
  /// Whether a red line leads from each point out of the second body. It is as long as the smaller body's
  /// size, times the part of the heavier body's weight in a step, m 9.81 dt, that the point carries: a tenth
  /// to all of the size.
  bool normals = true;
  /// Whether a magenta ball of the volume that both bodies share is drawn at its centroid. It costs a volume
  /// query for each pair, as pairOverlaps() does.
  bool volumes = true;
  /// Whether the spheres that bodies collide with are drawn in yellow, which is slow.
  bool spheres = false;
};

/// Draws the contacts of a world. Add it to the world, and debugDrawWorld() calls it, where the drawer's mode
/// has wireframes, boxes or normals:
///
///     ContactDrawer drawer(world);
///     world.addAction(&drawer);
///
/// The world must outlive it. Without a registration in the world's dispatcher nothing is drawn.
class ContactDrawer : public btActionInterface {
 public:
  /// Draws what the dispatcher of `world` knows. The world must outlive the drawer.
  explicit ContactDrawer(btCollisionWorld& world, const ContactDrawerOptions& options = {})
      : world_(world), options_(options) {}

  /// Notes the time step. Bullet calls it in each step, so programs need not.
  void updateAction(btCollisionWorld* world, btScalar time_step) override;
  /// Draws with `drawer`; null draws nothing. Bullet calls it from debugDrawWorld().
  void debugDraw(btIDebugDraw* drawer) override;

 private:
  btCollisionWorld& world_;
  ContactDrawerOptions options_;
  btScalar time_step_ = btScalar(1) / 60;  ///< The length of the last step [s].
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
