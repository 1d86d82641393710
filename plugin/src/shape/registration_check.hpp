// A world that nobody told of packings.
#pragma once

#include <atomic>
#include <string>

#include "innersphere/bullet_precision.hpp"

class btTransform;
class btTriangleCallback;

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// A dispatcher was registered.
void noticeRegistration();

/// Looks at what Bullet asks a shape for, and says in the log if its world cannot be registered. Safe to use
/// from several threads at once.
class RegistrationCheck {
 public:
  /// The shape's box is asked for: in a world for each body in each step, always at the same object. Once
  /// that cannot be somebody who measures shapes, and if nobody ever registered a dispatcher, the log says
  /// so: once in a process.
  void noticeBox(const btTransform& place);
  /// Its triangles are asked for. The log says so, once for the shape, if it is Bullet's narrow phase for
  /// convex shapes: with a registered dispatcher it is not used for packings. Rays, sweeps, soft bodies,
  /// GImpact shapes and users bring callbacks of their own.
  void noticeTriangles(const btTriangleCallback& callback, const std::string& source);

 private:
  std::atomic<unsigned> boxes_{0};
  std::atomic<const btTransform*> followed_{nullptr};
  std::atomic<int> repeats_{0};
  std::atomic<bool> said_{false};
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
