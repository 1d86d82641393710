#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>

#include "narrow_phase/shapes/distance_surface.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

class PlaneSurface : public DistanceSurface {
 public:
  explicit PlaneSurface(const btStaticPlaneShape& plane) : plane_(plane) {}

  bool isAsBefore() override {
    if (normal_ == plane_.getPlaneNormal() && constant_ == plane_.getPlaneConstant()) return true;
    normal_ = plane_.getPlaneNormal();
    constant_ = plane_.getPlaneConstant();
    return false;
  }

  /// In the packing's frame, where the plane's distance of a box is known.
  void findNearSpheres(const PlacedPacking& body, const btTransform& world,
                       std::vector<NearSphere>& near_spheres) override {
    const btTransform to_shape = world.inverseTimes(body.world);
    const btVector3& normal = plane_.getPlaneNormal();
    const btVector3 across = normal * to_shape.getBasis() * body.scale();
    const btVector3 extent = across.absolute() / 2;
    const btScalar offset = normal.dot(to_shape.getOrigin()) - plane_.getPlaneConstant();
    const auto near = [&](const btVector3& min, const btVector3& max) {
      return across.dot(min + max) / 2 + offset <= extent.dot(max - min) + body.largestExcess();
    };
    const auto test = [&](std::size_t i) {
      const btScalar distance = across.dot(centre(body.sphere(i))) + offset;
      if (!(distance < body.searchRadius(i))) return;
      near_spheres.push_back({static_cast<std::uint32_t>(i), distance, world.getBasis() * normal});
    };
    body.sphereBvh().forEach(near, test);
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

std::unique_ptr<ShapeSurface> makePlaneSurface(const btCollisionShape& shape) {
  return std::make_unique<PlaneSurface>(static_cast<const btStaticPlaneShape&>(shape));
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
