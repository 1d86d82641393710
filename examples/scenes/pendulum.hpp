// Bodies whose centre swings on a circle.
#pragma once

#include <cstddef>

#include "innersphere/geometry.hpp"

namespace innersphere::demo {

class SceneWorld;

/// A centre that slides without friction, and therefore without turning, on a vertical circle.
struct Pendulum {
  Vec3d pivot{};          ///< centre of the circle, which lies in the xz plane [m]
  double length = 1;      ///< its radius [m]
  double amplitude = 0;   ///< where it is let go, against the lowest place [rad]
  int swings = 5;         ///< after which it has to have come back
  double known_miss = 0;  ///< of the period [s], see Truth::known_miss

  /// [s] Of any amplitude: 2 pi sqrt(length / g) over the arithmetic-geometric mean of 1 and cos(amplitude /
  /// 2).
  double period() const;
};

/// Expects the period and that no amplitude is lost.
void expectPendulum(SceneWorld& world, std::size_t body, const Pendulum& pendulum);

}  // namespace innersphere::demo
