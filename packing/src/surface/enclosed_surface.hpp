// Declares integrals over the part of a surface that is in another solid.
#pragma once

#include "surface/grid_surface.hpp"

namespace innersphere {

/// Holds sums over triangles, each times how often the other solid encloses it.
struct EnclosedSums {
  double volume = 0;     ///< six times that of the cones from the origin to the triangles
  double magnitude = 0;  ///< the sum of absolute values in `volume`
  Vec3d moment{};        ///< 24 times the integral of the places in these cones
  Vec3d area{};          ///< twice the integral of the outward normal
  Vec3d turning{};       ///< six times the integral of place x outward normal
  double wetted = 0;     ///< twice the area
};

/// Returns the sums over the part of `own` that is in `other`, after findMeeting(). Places are seen from
/// `origin`, which should be near it. `volume_only`: with the first three alone.
EnclosedSums sumEnclosed(GridSurface& own, GridSurface& other, const Vec3d& origin, bool volume_only);

}  // namespace innersphere
