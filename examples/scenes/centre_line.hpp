// Tubes in recordings: how near their centre lines come to each other.
#pragma once

#include <cstddef>
#include <vector>

#include "innersphere/geometry.hpp"
#include "recording.hpp"

namespace innersphere::demo {

class SceneWorld;

/// The centre line of a tube.
struct CentreLine {
  std::size_t body = 0;
  std::vector<Vec3d> points;  ///< in the frame of the body [m]
  bool closed = false;
};

/// Of a body whose solid has this centre line in the frame of its mesh.
CentreLine centreLineOf(const SceneWorld& world, std::size_t body, const std::vector<Vec3d>& points,
                        bool closed);

/// The distance of two centre lines [m].
double distanceOf(const CentreLine& a, const CentreLine& b, const Recording& r, std::size_t step);

}  // namespace innersphere::demo
