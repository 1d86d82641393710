#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>

#include "surfaces/distance_surface.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

class PlaneSurface : public DistanceSurface {
 public:
  explicit PlaneSurface(const btStaticPlaneShape& plane) : plane_(plane) {}

  bool isAsBefore() override {
    const bool same = normal_ == plane_.getPlaneNormal() && constant_ == plane_.getPlaneConstant();
    normal_ = plane_.getPlaneNormal();
    constant_ = plane_.getPlaneConstant();
    return same;
  }

 private:
  bool nearest(const btVector3& p, Nearest& nearest) const override {
    nearest.normal = plane_.getPlaneNormal();
    nearest.distance = nearest.normal.dot(p) - plane_.getPlaneConstant();
    return true;
  }

  const btStaticPlaneShape& plane_;
  btVector3 normal_{0, 0, 0};
  btScalar constant_ = 0;
};

}  // namespace

std::unique_ptr<OtherSurface> makePlaneSurface(const btCollisionShape& shape) {
  return std::make_unique<PlaneSurface>(static_cast<const btStaticPlaneShape&>(shape));
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
