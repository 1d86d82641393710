// Says where a packed solid lies in the frame of a shape.
#pragma once

#include <LinearMath/btTransform.h>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/packing.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Holds the frame and the solid's bounds. They are of the surface and the spheres, in the shape's frame, for
/// scale 1 [m].
struct ShapeFrame {
  ShapeFrame(const Packing& packing, const btTransform& packing_to_shape);

  btTransform from_packing;
  btVector3 box_min;
  btVector3 box_max;
  btVector3 sphere_centre;
  btScalar sphere_radius = 0;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
