// Normals of a curved surface that was cut into triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <LinearMath/btVector3.h>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/geometry.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Neighbouring triangles that meet at less than 30 degrees are taken as one curved surface: its normal turns
/// smoothly across them. Sharper edges stay sharp, and flat faces exactly flat.
class SmoothNormals {
 public:
  explicit SmoothNormals(const Surface& surface);

  struct Place {
    btVector3 normal;  ///< unit
    btScalar bulge;    ///< how far the curved surface stands out of the triangle there [m]
  };
  /// At a point of a triangle.
  Place at(std::size_t triangle, const btVector3& point) const;
  /// Whether a sharp edge lies between a triangle and a point over its plane, not far away.
  bool isPastSharpEdge(std::size_t triangle, const btVector3& point) const;
  /// How far the surface goes on from a point of a triangle in a direction (unit), until it ends in a sharp
  /// edge; at most `farthest`, and no further than some triangles away [m].
  btScalar untilSharpEdge(std::size_t triangle, const btVector3& point, const btVector3& towards,
                          btScalar farthest) const;
  /// Of the surface across a triangle [1/m]: the curvature along that edge that shows most of it, positive
  /// where the solid is convex, exactly 0 where it is flat.
  btScalar curvature(std::size_t triangle) const;

 private:
  const Surface& surface_;
  std::vector<std::array<float, 3>> corners_;  ///< three normals a triangle
  std::vector<std::uint32_t> across_;          ///< triangles beyond its edges, from corner k to the next
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
