// How a row gives way within a substep.
#pragma once

#include <LinearMath/btScalar.h>

#include "innersphere/bullet_precision.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// An implicit spring-damper as a row of the solver sees it: with the error s of its place, the error v of
/// its speed, the mass m that it moves and its impulse j up to now, the impulse changes by
///   - m mass (v + rate s) - impulse j.
/// The formulae are those of implicit Euler (E. Catto, "Soft Constraints", GDC 2011).
struct Softness {
  btScalar rate = 0;     ///< [1/s]
  btScalar mass = 1;     ///< share of the mass
  btScalar impulse = 0;  ///< share of the impulse

  /// Returns the softness of a spring that would swing with `phase` radians in a substep [s], whatever mass
  /// is at it, at `damping` times critical damping.
  static Softness ofPhase(btScalar phase, btScalar damping, btScalar substep) {
    const btScalar give = 2 * damping + phase, mass = phase * give;
    return {phase / give / substep, mass / (1 + mass), 1 / (1 + mass)};
  }
  /// Returns that of a spring [N/m] and damper [N s/m] at a mass [kg].
  static Softness ofSpring(btScalar stiffness, btScalar damping, btScalar mass, btScalar substep) {
    const btScalar holds = substep * stiffness + damping;
    if (!(holds > 0)) return {0, 0, 0};
    const btScalar give = mass / (substep * holds);
    return {stiffness / holds, 1 / (1 + give), give / (1 + give)};
  }
};

/// What drives contacts apart swings through an eighth of a circle in a substep, at ten times critical
/// damping: slow enough for one pass to follow. Against what stands still it is twice as fast.
constexpr btScalar kContactPhase = SIMD_PI / 4, kContactDamping = 10;
/// The same of joints; their damping follows from the error reduction of the world.
constexpr btScalar kJointPhase = SIMD_PI / 2;

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
