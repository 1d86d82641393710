#include <BulletCollision/CollisionShapes/btCapsuleShape.h>

#include "narrow_phase/shapes/distance_surface.hpp"
#include "narrow_phase/shapes/segment_distance.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

class CapsuleSurface : public DistanceSurface {
 public:
  explicit CapsuleSurface(const btCapsuleShape& capsule) : capsule_(capsule) {}

  bool isAsBefore() override { return boxIsAsBefore(capsule_); }

 private:
  bool nearest(const btVector3& p, Nearest& nearest) const override {
    const int axis = capsule_.getUpAxis();
    const btScalar half = capsule_.getHalfHeight();
    btVector3 offset = p;
    offset[axis] -= btClamped(p[axis], -half, half);
    btVector3 sideways(0, 0, 0);
    sideways[(axis + 1) % 3] = 1;
    nearest.distance = thickenedDistance(offset, capsule_.getRadius(), sideways, nearest.normal);
    nearest.curvature = 1 / capsule_.getRadius();
    return true;
  }

  const btCapsuleShape& capsule_;
};

}  // namespace

std::unique_ptr<ShapeSurface> makeCapsuleSurface(const btCollisionShape& shape) {
  return std::make_unique<CapsuleSurface>(static_cast<const btCapsuleShape&>(shape));
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
