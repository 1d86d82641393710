// Enlarges the spheres of a packing until they cover its surface.
#pragma once

#include <vector>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/packing.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Returns spheres inside of a surface, each enlarged as far as the part of the surface that it stands for.
/// Each point of the surface is in one of them. So wherever two surfaces are no further apart than some
/// distance, two enlarged spheres are that near to each other, and a search by that distance finds them. A
/// sphere stands for points that it is nearest to, or further from than the nearest by 0.2 % of the solid's
/// size (the diagonal of its box) at most. Inner spheres, which stand for none, stay as they are. Small balls
/// with wide gaps are no packing, and all enlarged by the same.
std::vector<Sphere> searchSpheres(const Surface& surface, std::vector<Sphere> spheres);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
