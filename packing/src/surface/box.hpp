// Declares boxes along the axes, and what is done with them.
#pragma once

#include <algorithm>
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

inline bool isWithin(const Bounds& a, const Bounds& b) {
  return a.min.x >= b.min.x && a.max.x <= b.max.x && a.min.y >= b.min.y && a.max.y <= b.max.y &&
         a.min.z >= b.min.z && a.max.z <= b.max.z;
}

}  // namespace innersphere
