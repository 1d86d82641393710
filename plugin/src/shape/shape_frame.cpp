#include "shape/shape_frame.hpp"

#include "common/bullet_vectors.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

ShapeFrame::ShapeFrame(const Packing& packing, const btTransform& packing_to_shape)
    : from_packing(packing_to_shape),
      box_min(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT),
      box_max(-box_min) {
  for (const auto& vertex : packing.surface.vertices) {
    const btVector3 v = from_packing(toBullet(vertex));
    box_min.setMin(v);
    box_max.setMax(v);
  }
  for (const Sphere& s : packing.spheres) {
    const btVector3 c = from_packing(centre(s));
    const btVector3 r(s.radius, s.radius, s.radius);
    box_min.setMin(c - r);
    box_max.setMax(c + r);
  }
  sphere_centre = (box_min + box_max) / 2;
  for (const auto& vertex : packing.surface.vertices) {
    sphere_radius = btMax(sphere_radius, sphere_centre.distance(from_packing(toBullet(vertex))));
  }
  for (const Sphere& s : packing.spheres) {
    const btVector3 c = from_packing(centre(s));
    sphere_radius = btMax(sphere_radius, sphere_centre.distance(c) + btScalar(s.radius));
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
