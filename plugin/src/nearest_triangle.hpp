// The nearest point of a solid's surface.
#pragma once

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/geometry.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Bullet's own box tree over the triangles of a Surface, in the surface's frame. Refers to the surface: it
/// must stay. Const members are safe to call from several threads at once.
class NearestTriangle {
 public:
  explicit NearestTriangle(const Surface& surface);
  NearestTriangle(const NearestTriangle&) = delete;
  NearestTriangle& operator=(const NearestTriangle&) = delete;

  struct Result {
    btScalar distance;  ///< [m], negative inside the solid
    btVector3 normal;   ///< unit, out of the solid, along the line from the nearest point
  };
  /// False if the surface is further away from `point` than `reach`.
  bool find(const btVector3& point, btScalar reach, Result& result) const;

 private:
  const Surface& surface_;
  btDbvt tree_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
