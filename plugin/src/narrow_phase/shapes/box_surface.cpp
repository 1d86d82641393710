#include <BulletCollision/CollisionShapes/btBoxShape.h>

#include "narrow_phase/shapes/distance_surface.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

class BoxSurface : public DistanceSurface {
 public:
  explicit BoxSurface(const btBoxShape& box) : box_(box) {}

  bool isAsBefore() override { return boxIsAsBefore(box_); }

 private:
  bool nearest(const btVector3& p, Nearest& nearest) const override {
    const btVector3 half = box_.getHalfExtentsWithMargin();
    const btVector3 beyond = p.absolute() - half;
    btVector3 outside = beyond;
    outside.setMax(btVector3(0, 0, 0));
    const btScalar length = outside.length();
    if (length > 0) {
      nearest.distance = length;
      nearest.normal = outside / length;
      if (length > outside[outside.maxAxis()]) nearest.edged = &box_;
    } else {
      const int axis = beyond.maxAxis();
      nearest.distance = beyond[axis];
      nearest.normal.setZero();
      nearest.normal[axis] = 1;
    }
    for (int i = 0; i < 3; ++i) {
      if (p[i] < 0) nearest.normal[i] = -nearest.normal[i];
    }
    return true;
  }

  const btPolyhedralConvexShape* polyhedron() const override { return &box_; }

  const btBoxShape& box_;
};

}  // namespace

std::unique_ptr<ShapeSurface> makeBoxSurface(const btCollisionShape& shape) {
  return std::make_unique<BoxSurface>(static_cast<const btBoxShape&>(shape));
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
