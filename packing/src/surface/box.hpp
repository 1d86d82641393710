// Declares boxes along the axes, and what is done with them.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "innersphere/geometry.hpp"

namespace innersphere {

inline Bounds nothing() {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  return {{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
}

inline bool isEmpty(const Bounds& box) {
  return box.min.x > box.max.x || box.min.y > box.max.y || box.min.z > box.max.z;
}

inline Bounds common(const Bounds& a, const Bounds& b) {
  Bounds c;
  for (int k = 0; k < 3; ++k) {
    c.min[k] = std::max(a.min[k], b.min[k]);
    c.max[k] = std::min(a.max[k], b.max[k]);
  }
  return c;
}

inline void include(const Bounds& part, Bounds& whole) {
  for (int k = 0; k < 3; ++k) {
    whole.min[k] = std::min(whole.min[k], part.min[k]);
    whole.max[k] = std::max(whole.max[k], part.max[k]);
  }
}

/// Returns the largest absolute value of a component.
inline double largest(const Vec3d& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Returns that of a place in the box.
inline double largest(const Bounds& box) {
  return std::max(largest(box.min), largest(box.max));
}

}  // namespace innersphere
