// Declares what the narrow phase hands to Bullet.
#pragma once

#include <array>
#include <cstdint>

#include <LinearMath/btVector3.h>

#include "innersphere/bullet_precision.hpp"
#include "narrow_phase/hill.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// A patch has as many points, at most, as Bullet keeps in a manifold.
constexpr int kPatchPoints = 4;

/// This is the id of the deepest point between curved surfaces. Those of the next three come before it; no
/// sphere has them.
constexpr std::uint64_t kDeepestId = ~std::uint64_t(0);

/// Returns true for those.
inline bool isDeepest(std::uint64_t id) {
  return id > kDeepestId - kPatchPoints;
}

/// This is a point of contact. It has the axes of the world, and positions are relative to the origin of A's
/// packing.
struct ContactPoint {
  btVector3 on_b{0, 0, 0};          ///< on the surface of B [m]
  btVector3 normal{0, 0, 0};        ///< unit, from A to B
  btScalar depth = 0;               ///< [m], negative where the bodies do not touch yet
  std::uint64_t id = 0;             ///< of the sphere that it was found at, the same from step to step
  Bend bend_a, bend_b;              ///< of the surfaces there, in two axes across the normal
  btVector3 bend_x{1, 0, 0};        ///< the first one, which goes with B
  btScalar turn_a = btScalar(0.5);  ///< how much of A's turning the normal takes part in, the rest of B's
  /// How much deeper the surfaces are at the top of the hill that the point is on, by their slope and
  /// curvature [m]. 0 at a top, at a corner, and where faces are flat or fit together.
  btScalar below_top = 0;
  btVector3 to_top{0, 0, 0};  ///< the way there [m]
  /// Where A's point is beside B's, of bodies that will have come there only later in the step [m].
  btVector3 aside{0, 0, 0};
};

/// Returns the axes in which it is told how surfaces bend at a point.
inline Across bendAxes(const ContactPoint& point) {
  return {point.bend_x, point.normal.cross(point.bend_x)};
}

/// This is a part of the overlap region with one direction of contact. It becomes one manifold.
struct ContactPatch {
  btVector3 normal{0, 0, 0};  ///< unit, from A to B
  btVector3 centre{0, 0, 0};
  btScalar area = 0;       ///< [m^2]
  btScalar radius = 0;     ///< mean distance of the area from its centre [m]
  bool by_volume = false;  ///< depths are volume over area: they do not say how far the bodies have to go
  int count = 0;
  std::array<ContactPoint, kPatchPoints> points;

  /// Of the deepest point [m]; minus BT_LARGE_FLOAT without points.
  btScalar depth() const {
    btScalar deepest = -BT_LARGE_FLOAT;
    for (int i = 0; i < count; ++i) deepest = btMax(deepest, points[i].depth);
    return deepest;
  }
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
