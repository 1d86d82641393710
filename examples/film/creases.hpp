// Surfaces for shading: smooth where they are smooth, sharp at their edges.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "innersphere/geometry.hpp"

namespace innersphere::demo {

/// A surface whose vertices were doubled along its edges, with one normal each.
struct ShadedSurface {
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::array<float, 3>> normals;  ///< unit length, outward
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Triangles that meet at less than `crease_angle` [rad] are shaded as one smooth surface.
ShadedSurface splitCreases(const Surface& surface, double crease_angle = 0.8);

}  // namespace innersphere::demo
