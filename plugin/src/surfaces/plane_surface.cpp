#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>

#include "surfaces/distance_surface.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

class PlaneSurface : public DistanceSurface {
 public:
  explicit PlaneSurface(const btStaticPlaneShape& plane) : plane_(plane) {}

 private:
  bool nearest(const btVector3& p, Nearest& nearest) const override {
    nearest.normal = plane_.getPlaneNormal();
    nearest.distance = nearest.normal.dot(p) - plane_.getPlaneConstant();
    return true;
  }

  const btStaticPlaneShape& plane_;
};

}  // namespace

std::unique_ptr<OtherSurface> makePlaneSurface(const btCollisionShape& shape) {
  return std::make_unique<PlaneSurface>(static_cast<const btStaticPlaneShape&>(shape));
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
