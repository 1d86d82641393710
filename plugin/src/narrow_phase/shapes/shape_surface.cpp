#include "narrow_phase/shapes/shape_surface.hpp"

#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>

#include "narrow_phase/shapes/distance_surface.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

std::unique_ptr<ShapeSurface> makeShapeSurface(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case STATIC_PLANE_PROXYTYPE:
      return makePlaneSurface(shape);
    case SPHERE_SHAPE_PROXYTYPE:
      return makeSphereSurface(shape);
    case BOX_SHAPE_PROXYTYPE:
      return makeBoxSurface(shape);
    case CAPSULE_SHAPE_PROXYTYPE:
      return makeCapsuleSurface(shape);
    case MULTI_SPHERE_SHAPE_PROXYTYPE:
      return makeMultiSphereSurface(shape);
    case CYLINDER_SHAPE_PROXYTYPE:
      return makeCylinderSurface(shape);
    case CONE_SHAPE_PROXYTYPE:
      return makeConeSurface(shape);
    case SDF_SHAPE_PROXYTYPE:
      if (std::unique_ptr<ShapeSurface> sdf = makeSdfSurface(shape)) return sdf;
      return makeTriangleSurface(shape);
    default:
      if (shape.isConvex()) return makeConvexSurface(shape);
      if (shape.isConcave()) return makeTriangleSurface(shape);
      return nullptr;
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
