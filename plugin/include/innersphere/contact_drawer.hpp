// Contacts, overlaps and spheres in Bullet's debug drawer.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletDynamics/Dynamics/btActionInterface.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// What is drawn.
struct ContactDrawerOptions {
  bool patches = true;  ///< outline of the points of each patch, blue
  bool normals = true;  ///< from each point out of the second body, as long as the body's size times how much
                        ///< of its weight in a step, m 9.81 dt, the point carries; red, at least a tenth
  bool volumes = true;  ///< a ball of the shared volume at its centroid, magenta; costs a query a pair
  bool spheres = false;  ///< the spheres that bodies collide with, each as three circles: slow, yellow
};

/// Add it to a world, and the world's debugDrawWorld() calls it, where the drawer's mode has wireframes,
/// boxes or normals:
///
///     ContactDrawer drawer(world);
///     world.addAction(&drawer);
///
/// The world must outlive it. Without a registration in the world's dispatcher nothing is drawn.
class ContactDrawer : public btActionInterface {
 public:
  /// Draws what the dispatcher of this world knows.
  explicit ContactDrawer(btCollisionWorld& world, const ContactDrawerOptions& options = {})
      : world_(world), options_(options) {}

  /// Bullet calls it in each step.
  void updateAction(btCollisionWorld* world, btScalar time_step) override;
  /// Bullet calls it from debugDrawWorld().
  void debugDraw(btIDebugDraw* drawer) override;

 private:
  btCollisionWorld& world_;
  ContactDrawerOptions options_;
  btScalar time_step_ = btScalar(1) / 60;  ///< of the last step [s]
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
