#include "surfaces/distance_surface.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

void DistanceSurface::touch(const PackingBody& body, const btTransform& world, std::vector<Touch>& touches) {
  const btTransform to_shape = world.inverseTimes(body.world);
  const btScalar scale = body.scale();
  const auto near = [&](const btVector3& min, const btVector3& max) {
    const btScalar radius = btScalar(0.5) * (max - min).length() * scale;
    return lowerBound(to_shape((min + max) * (btScalar(0.5) * scale))) <= radius + body.largestExcess();
  };
  const auto test = [&](std::size_t i) {
    Nearest found;
    if (!nearest(to_shape(centre(body.shape().packing().spheres[i]) * scale), found)) return;
    if (found.distance >= body.reach(i)) return;
    touches.push_back(
        {static_cast<std::uint32_t>(i), found.distance, world.getBasis() * found.normal, found.curvature});
  };
  body.sphereTree().forEach(near, test);
}

btScalar DistanceSurface::lowerBound(const btVector3& p) const {
  Nearest found;
  return nearest(p, found) ? found.distance : BT_LARGE_FLOAT;
}

btScalar DistanceSurface::boxDistance(const btCollisionShape& shape, const btVector3& p) {
  btVector3 min, max;
  shape.getAabb(btTransform::getIdentity(), min, max);
  btVector3 beyond = min - p;
  beyond.setMax(p - max);
  beyond.setMax(btVector3(0, 0, 0));
  return beyond.length();
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
