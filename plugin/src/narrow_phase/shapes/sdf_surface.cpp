#include <BulletCollision/CollisionShapes/btSdfCollisionShape.h>

#include "narrow_phase/shapes/distance_surface.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

class SdfSurface : public DistanceSurface {
 public:
  explicit SdfSurface(const btSdfCollisionShape& sdf) : sdf_(sdf) {}

 private:
  bool isConvex() const override { return false; }
  bool nearest(const btVector3& p, Nearest& nearest) const override {
    // queryPoint is const in all but its declaration.
    if (!const_cast<btSdfCollisionShape&>(sdf_).queryPoint(p, nearest.distance, nearest.normal)) return false;
    const btScalar length = nearest.normal.length();
    if (!(length > 0)) return false;
    nearest.normal /= length;
    return true;
  }

  // The field is undefined outside its box, where the tree's larger balls may be centred.
  btScalar lowerBound(const btVector3& p) const override { return boxDistance(sdf_, p); }

  const btSdfCollisionShape& sdf_;
};

}  // namespace

std::unique_ptr<ShapeSurface> makeSdfSurface(const btCollisionShape& shape) {
  const auto* sdf = dynamic_cast<const btSdfCollisionShape*>(&shape);
  return sdf != nullptr ? std::make_unique<SdfSurface>(*sdf) : nullptr;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
