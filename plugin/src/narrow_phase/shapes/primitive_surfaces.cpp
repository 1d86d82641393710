// Spheres, boxes, capsules and all other convex shapes.
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConvexShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include "common/bullet_vectors.hpp"
#include "narrow_phase/shapes/distance_surface.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// A shape of one class, which has changed where its box has.
template <typename Shape>
class PrimitiveSurface : public DistanceSurface {
 public:
  explicit PrimitiveSurface(const btCollisionShape& shape) : shape_(static_cast<const Shape&>(shape)) {}

  bool isAsBefore() override { return boxIsAsBefore(shape_); }

 protected:
  const Shape& shape_;
};

/// Signed distance of a point at `offset` from the nearest point of a core that is thickened by `radius`.
/// `normal` is the outward direction, `fallback` where the point lies on the core.
btScalar thickenedDistance(const btVector3& offset, btScalar radius, const btVector3& fallback,
                           btVector3& normal) {
  const btScalar length = offset.length();
  normal = length > SIMD_EPSILON * radius ? offset / length : fallback;
  return length - radius;
}

class SphereSurface : public PrimitiveSurface<btSphereShape> {
 public:
  using PrimitiveSurface::PrimitiveSurface;

 private:
  bool nearest(const btVector3& p, Nearest& nearest) const override {
    nearest.distance = thickenedDistance(p, shape_.getRadius(), btVector3(0, 1, 0), nearest.normal);
    nearest.curvature = 1 / shape_.getRadius();
    return true;
  }
};

class CapsuleSurface : public PrimitiveSurface<btCapsuleShape> {
 public:
  using PrimitiveSurface::PrimitiveSurface;

 private:
  bool nearest(const btVector3& p, Nearest& nearest) const override {
    const int axis = shape_.getUpAxis();
    const btScalar half = shape_.getHalfHeight();
    btVector3 offset = p;
    offset[axis] -= btClamped(p[axis], -half, half);
    btVector3 sideways(0, 0, 0);
    sideways[(axis + 1) % 3] = 1;
    nearest.distance = thickenedDistance(offset, shape_.getRadius(), sideways, nearest.normal);
    nearest.curvature = 1 / shape_.getRadius();
    return true;
  }
};

class BoxSurface : public PrimitiveSurface<btBoxShape> {
 public:
  using PrimitiveSurface::PrimitiveSurface;

 private:
  bool nearest(const btVector3& p, Nearest& nearest) const override {
    const btVector3 half = shape_.getHalfExtentsWithMargin();
    const btVector3 beyond = p.absolute() - half;
    btVector3 outside = beyond;
    outside.setMax(btVector3(0, 0, 0));
    const btScalar length = outside.length();
    if (length > 0) {
      nearest.distance = length;
      nearest.normal = outside / length;
      if (length > outside[outside.maxAxis()]) nearest.edged = &shape_;
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

  const btPolyhedralConvexShape* polyhedron() const override { return &shape_; }
};

/// Any convex shape, by Bullet's GJK outside and EPA inside. Its margin counts as part of it, as in Bullet.
class ConvexSurface : public PrimitiveSurface<btConvexShape> {
 public:
  using PrimitiveSurface::PrimitiveSurface;

 private:
  bool nearest(const btVector3& p, Nearest& nearest) const override {
    btGjkEpaSolver2::sResults results;
    results.normal.setZero();
    const btScalar distance =
        btGjkEpaSolver2::SignedDistance(p, 0, &shape_, btTransform::getIdentity(), results);
    if (!(btFabs(distance) < BT_LARGE_FLOAT) || !isFinite(results.normal) || results.normal.fuzzyZero())
      return false;
    nearest.distance = distance;
    nearest.normal = results.normal.normalized();
    nearest.edged = &shape_;
    return true;
  }

  btScalar lowerBound(const btVector3& p) const override { return boxDistance(shape_, p); }

  const btPolyhedralConvexShape* polyhedron() const override {
    return dynamic_cast<const btPolyhedralConvexShape*>(&shape_);
  }
};

}  // namespace

std::unique_ptr<ShapeSurface> makeSphereSurface(const btCollisionShape& shape) {
  return std::make_unique<SphereSurface>(shape);
}

std::unique_ptr<ShapeSurface> makeCapsuleSurface(const btCollisionShape& shape) {
  return std::make_unique<CapsuleSurface>(shape);
}

std::unique_ptr<ShapeSurface> makeBoxSurface(const btCollisionShape& shape) {
  return std::make_unique<BoxSurface>(shape);
}

std::unique_ptr<ShapeSurface> makeConvexSurface(const btCollisionShape& shape) {
  return std::make_unique<ConvexSurface>(shape);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
