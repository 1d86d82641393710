// Volume, centre of mass and inertia of what a mesh encloses or a function says is inside.
#pragma once

#include <functional>

#include "innersphere/geometry.hpp"
#include "innersphere/mesh.hpp"

namespace innersphere {

/// Moments of a region of unit density about `origin`: they add up over regions.
struct Moments {
  Vec3d origin{};
  double volume = 0;
  Vec3d first{};                   ///< integral of x
  std::array<double, 6> second{};  ///< integrals of xx, yy, zz, xy, yz, zx

  void addPoint(const Vec3d& p, double volume);
  void add(const Moments& other);  ///< about the same origin
  MassProperties massProperties() const;
};

/// By the divergence theorem, exact but for rounding, about the middle of the mesh so that no digits are lost
/// far from the origin. Of a mesh that is not closed the result means nothing.
Moments momentsOf(const Mesh& mesh);

/// Midpoint rule over the cells of `box`, `resolution` of them along its longest
/// side, each weighted with weight(middle).
Moments sampledMoments(const Bounds& box, int resolution, const std::function<double(const Vec3d&)>& weight);

}  // namespace innersphere
