#include <BulletCollision/CollisionShapes/btConvexShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include "common/bullet_vectors.hpp"
#include "narrow_phase/shapes/distance_surface.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Any convex shape, by Bullet's GJK outside and EPA inside. Its margin counts as part of it, as in Bullet.
class ConvexSurface : public DistanceSurface {
 public:
  explicit ConvexSurface(const btConvexShape& convex) : convex_(convex) {}

  bool isAsBefore() override { return boxIsAsBefore(convex_); }

 private:
  bool nearest(const btVector3& p, Nearest& nearest) const override {
    btGjkEpaSolver2::sResults results;
    results.normal.setZero();
    const btScalar distance =
        btGjkEpaSolver2::SignedDistance(p, 0, &convex_, btTransform::getIdentity(), results);
    if (!(btFabs(distance) < BT_LARGE_FLOAT) || !isFinite(results.normal) || results.normal.fuzzyZero())
      return false;
    nearest.distance = distance;
    nearest.normal = results.normal.normalized();
    nearest.edged = &convex_;
    return true;
  }

  btScalar lowerBound(const btVector3& p) const override { return boxDistance(convex_, p); }

  const btPolyhedralConvexShape* polyhedron() const override {
    return dynamic_cast<const btPolyhedralConvexShape*>(&convex_);
  }

  const btConvexShape& convex_;
};

}  // namespace

std::unique_ptr<ShapeSurface> makeConvexSurface(const btCollisionShape& shape) {
  return std::make_unique<ConvexSurface>(static_cast<const btConvexShape&>(shape));
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
