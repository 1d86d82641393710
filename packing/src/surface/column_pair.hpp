// Declares what two triangles that lie above each other contribute to the volume that two solids share.
#pragma once

#include "innersphere/geometry.hpp"

namespace innersphere {

/// This is a triangle in a frame whose z is the direction of columns.
struct ColumnTriangle {
  Vec3d corners[3];
  Bounds box;
  Vec3d normal;  ///< of twice its area
  int side;      ///< 1: it faces up, -1: it faces down, 0: it is seen from its edge and has no columns
};

/// Returns a triangle with all that follows from its corners.
ColumnTriangle makeColumnTriangle(const Vec3d& a, const Vec3d& b, const Vec3d& c);

/// Holds sums over pairs of triangles, t of A and u of B.
struct SharedSums {
  double volume = 0;
  Vec3d moment{};        ///< of the volume, about the origin
  Vec3d area{};          ///< the integral of the outward normal over B's surface in A
  Vec3d turning{};       ///< the integral of place x outward normal there
  double wetted = 0;     ///< the area of B's surface in A
  double magnitude = 0;  ///< the sum of the volumes' absolute values, to tell rounding from volume
};

/// Adds what t and u contribute in a box: where t is above u, all of it that is between them.
void addColumnPair(const ColumnTriangle& t, const ColumnTriangle& u, const Bounds& box, SharedSums& sums);

}  // namespace innersphere
