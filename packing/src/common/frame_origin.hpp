// Decides where a packing has its origin.
#pragma once

#include "common/bounds.hpp"

namespace innersphere {

/// Returns the middle of the box [m], rounded to about its size, so that spheres in it lose little in single
/// precision. Returns zero if the box is nearer than eight of its sizes: such a solid shall keep its
/// coordinates.
inline Vec3d frameOrigin(const Bounds& box) {
  const Vec3d size = box.max - box.min;
  const double longest = std::max({size[0], size[1], size[2]});
  Vec3d origin = centre(box);
  if (!(norm(origin) > 8 * longest)) return {};
  const double step = std::ldexp(1.0, std::ilogb(longest));
  for (double& x : origin) x = step * std::round(x / step) + 0.0;  // never -0
  return origin;
}

}  // namespace innersphere
