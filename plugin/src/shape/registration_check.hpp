// Notices a world that nobody told of packings.
#pragma once

#include <atomic>
#include <string>

#include "innersphere/bullet_precision.hpp"

class btTriangleCallback;

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Notes that a dispatcher was registered.
void noticeRegistration();

/// Notes that a shape's box is asked for, as Bullet does for each body in each step. Says in the log, once in
/// a process, if that has happened often and no dispatcher was ever registered.
void noticeBox();

/// Looks at who asks a shape for its triangles. Safe to use from several threads at once.
class RegistrationCheck {
 public:
  /// Says in the log, once for the shape, that it is Bullet's narrow phase for convex shapes: with a
  /// registered dispatcher it is not used for packings. Rays, sweeps, soft bodies, GImpact shapes and users
  /// bring callbacks of their own.
  void noticeTriangles(const btTriangleCallback& callback, const std::string& source);

 private:
  std::atomic<bool> said_{false};
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
