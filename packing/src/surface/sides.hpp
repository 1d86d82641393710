// Declares on which side of each other points, edges and triangles lie, decided exactly.
#pragma once

#include "innersphere/geometry.hpp"

namespace innersphere {

// All corners lie on a grid: their coordinates are whole numbers. So a sign can be computed without rounding,
// which is done where double precision does not decide. Of two surfaces the second one, B, is moved by an
// infinitely small d = (e, e^2, e^3): then no sign is zero, and all fit together, as they are those of real
// surfaces. What is continuous, such as the volume that both share, does not notice.

/// Coordinates are at most 2^kGridBits. Then six times the product of three differences is less than 2^127.
constexpr int kGridBits = 39;

/// This is a triangle with its corners on the grid.
struct GridTriangle {
  GridTriangle(const Vec3d& a, const Vec3d& b, const Vec3d& c);
  Vec3d corners[3];
  Vec3d normal;     ///< of twice its area
  double size;      ///< the largest component of a way from the first corner to another
  double rounding;  ///< of the normal times a vector, by the largest component of that
};

/// Says which of two surfaces is the one that is moved.
enum class Moved { point, triangle };

/// Says how the corners of a triangle lie to the plane of another one.
struct Corners {
  double heights[3];  ///< above the plane, times the length of its normal; rounded
  bool above[3];      ///< exact
  int alone;          ///< this one lies on its own side, -1 if all lie on one

  /// Returns the edge that leads from the corner that is alone, or to it. Edge k leads from corner k to the
  /// next.
  int edge(bool from_alone) const { return from_alone ? alone : (alone + 2) % 3; }
};

/// Returns how the corners of a triangle of the surface that `moved` names lie to the plane.
Corners cornersAbove(const GridTriangle& plane, const GridTriangle& triangle, Moved moved);

/// The planes of t, of A, and u, of B, meet in a line, which two edges of each cross. An edge leads from a
/// corner to the next.
class EdgeOrder {
 public:
  EdgeOrder(const GridTriangle& t, const Corners& at_u, const GridTriangle& u, const Corners& at_t);
  /// Returns whether along the line, in the direction normal of t x normal of u, an edge of t comes before
  /// one of u.
  bool comesBefore(int of_t, int of_u) const;

 private:
  const GridTriangle &t_, &u_;
  const Corners &at_u_, &at_t_;
  double rounding_;
};

/// Returns by how much a triangle adds to the winding number of a point: 1 where it is above it, in the
/// direction z, and faces up, -1 where it faces down, 0 elsewhere.
int windingBelow(const GridTriangle& triangle, const Vec3d& point, Moved moved);

}  // namespace innersphere
