// Computes with boxes along the axes.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "innersphere/geometry.hpp"

namespace innersphere {

inline bool isFinite(const Vec3d& a) {
  return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]);
}

/// Returns a box that holds nothing and grows by extend().
inline Bounds emptyBounds() {
  constexpr double inf = std::numeric_limits<double>::infinity();
  return {{inf, inf, inf}, {-inf, -inf, -inf}};
}
inline void extend(Bounds& box, const Vec3d& p) {
  for (int k = 0; k < 3; ++k) {
    box.min[k] = std::min(box.min[k], p[k]);
    box.max[k] = std::max(box.max[k], p[k]);
  }
}
/// Returns the box around the triangles.
inline Bounds boundsOf(const Mesh& mesh) {
  Bounds box = emptyBounds();
  for (const auto& t : mesh.triangles) {
    for (std::uint32_t v : t) extend(box, mesh.vertices[v]);
  }
  return box;
}
inline Vec3d centre(const Bounds& box) {
  return 0.5 * (box.min + box.max);
}
inline double diagonal(const Bounds& box) {
  return norm(box.max - box.min);
}
inline bool holds(const Bounds& box, const Vec3d& p) {
  for (int k = 0; k < 3; ++k) {
    if (!(p[k] >= box.min[k] && p[k] <= box.max[k])) return false;
  }
  return true;
}
inline bool holds(const Bounds& outer, const Bounds& inner) {
  return holds(outer, inner.min) && holds(outer, inner.max);
}
inline bool meet(const Bounds& a, const Bounds& b) {
  for (int k = 0; k < 3; ++k) {
    if (a.min[k] > b.max[k] || b.min[k] > a.max[k]) return false;
  }
  return true;
}

}  // namespace innersphere
