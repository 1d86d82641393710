// Places balls where the spheres of a packing leave its surface out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "innersphere/packing.hpp"
#include "surface/surface_queries.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Holds balls inside of a solid that touch its surface where no sphere is near it: in thin walls, horns and
/// corners. They feel contact. They overlap spheres and each other, so they bear no volume.
struct Feelers {
  std::vector<Sphere> balls;
  std::vector<std::uint32_t> triangles;  ///< that they touch
  std::vector<std::uint32_t> spheres;    ///< that they are nearest to
  btScalar largest_radius = 0;           ///< of the balls: half as thick as the solid is there [m]
  btScalar inset = 0;  ///< how far spheres and balls together may end inside of the surface [m]
};

/// Says where balls are placed.
enum class FeelerPlaces : std::uint8_t {
  all,
  thin,  ///< only where the solid is thinner than twice the gap to the nearest sphere, see isThinner()
};

/// Places balls until no place of the surface is further from the first `count` spheres and the balls than 1
/// % of the solid's size (the diagonal of its box), but for what lies between the places looked at. Each is
/// the largest ball inside that touches the place which is furthest away: Ma, Bae and Choi, "3D medial axis
/// point approximation using nearest neighbors and the normal field", The Visual Computer 28 (2012). `inset`
/// is how far the spheres alone may end inside of the surface [m]: where that is less, no ball is needed.
Feelers placeFeelers(const Packing& packing, std::size_t count, btScalar inset, const SurfaceQueries& surface,
                     FeelerPlaces where);

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
