#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include "narrow_phase/shapes/distance_surface.hpp"
#include "narrow_phase/shapes/segment_distance.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

class SphereSurface : public DistanceSurface {
 public:
  explicit SphereSurface(const btSphereShape& sphere) : sphere_(sphere) {}

  bool isAsBefore() override { return boxIsAsBefore(sphere_); }

 private:
  bool nearest(const btVector3& p, Nearest& nearest) const override {
    nearest.distance = thickenedDistance(p, sphere_.getRadius(), btVector3(0, 1, 0), nearest.normal);
    nearest.curvature = 1 / sphere_.getRadius();
    return true;
  }

  const btSphereShape& sphere_;
};

}  // namespace

std::unique_ptr<ShapeSurface> makeSphereSurface(const btCollisionShape& shape) {
  return std::make_unique<SphereSurface>(static_cast<const btSphereShape&>(shape));
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
