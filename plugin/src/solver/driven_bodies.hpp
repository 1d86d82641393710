// Says how bodies go through a step that move by themselves.
#pragma once

#include <vector>

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// The mean velocities of a body in a step, and how they change evenly in it.
struct DrivenMotion {
  btVector3 velocity{0, 0, 0};              ///< [m/s]
  btVector3 spin{0, 0, 0};                  ///< [rad/s]
  btVector3 acceleration{0, 0, 0};          ///< [m/s^2]
  btVector3 angular_acceleration{0, 0, 0};  ///< [rad/s^2]
};

/// Bullet says of a kinematic body how far it goes in a step, as a velocity. If substeps took it on at once,
/// friction would lag in each step by the time that it takes to gain that. So it is gained in the course of
/// the step, by as much as both this step and the one before gained: what jumps, jumps.
///
/// Bullet takes turns from the cosine of half their angle. In single precision that knows none below
/// 7e-4 rad, and others by steps of as much: such spins are taken from poses here.
class DrivenBodies {
 public:
  /// Returns how a kinematic body goes through this step of `time_step` [s]: once or more in each.
  DrivenMotion motionOf(const btRigidBody& body, btScalar time_step);
  /// Bodies that no one asked for in a step are forgotten.
  void endStep();

 private:
  struct Past {
    const btRigidBody* body = nullptr;
    btQuaternion rotation = btQuaternion::getIdentity();
    bool turned = false;  ///< in that step
    DrivenMotion motion;
    btVector3 gained{0, 0, 0}, spin_gained{0, 0, 0};  ///< from the step before
  };
  std::vector<Past> before_;  ///< sorted by body
  std::vector<Past> now_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
