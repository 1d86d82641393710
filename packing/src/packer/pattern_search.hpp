// Gives the steps of a pattern search.
#pragma once

#include <array>
#include <cmath>

#include "packer/ball.hpp"

namespace innersphere {

/// Returns unit vectors to the faces and the corners of a cube.
inline std::array<Point, 14> patternDirections() {
  std::array<Point, 14> ways;
  for (int i = 0; i < 14; ++i) {
    ways[i] = Point::Zero();
    if (i < 6) {
      ways[i][i / 2] = i % 2 ? 1 : -1;
    } else {
      for (int k = 0; k < 3; ++k) ways[i][k] = (i - 6) >> k & 1 ? std::sqrt(1.0 / 3) : -std::sqrt(1.0 / 3);
    }
  }
  return ways;
}

}  // namespace innersphere
