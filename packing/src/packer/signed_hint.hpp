// What is known of the surface around a point.
#pragma once

#include <cmath>

#include "packer/ball.hpp"

namespace innersphere {

/// The surface is at least |distance| away from `at`, which lies inside if distance > 0 and outside if
/// distance < 0.
struct SignedHint {
  Point at;
  double distance = 0;  ///< 0: nothing is known

  /// The same about x: how far the surface is at least, or less than 0 if the hint does not reach x.
  double clearance(const Point& x) const { return std::abs(distance) - (x - at).norm() * (1 + 1e-9); }
  bool inside() const { return distance > 0; }
};

}  // namespace innersphere
