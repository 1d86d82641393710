// Declares on which side of each other points, edges and triangles lie, decided exactly.
#pragma once

#include <cmath>
#include <cstdint>

#include "innersphere/geometry.hpp"

namespace innersphere {

// All corners lie on a grid: their coordinates are whole numbers. So a sign can be computed without rounding,
// which is done where double precision does not decide. Of two surfaces the second one, B, is moved by an
// infinitely small d = (e, e^2, e^3): then no sign is zero, and all fit together, as they are those of real
// surfaces. What is continuous, such as the volume that both share, does not notice.

/// Coordinates are at most 2^kGridBits. Then six times the product of three differences is less than 2^127.
constexpr int kGridBits = 39;

/// Says which of two surfaces is the one that is moved.
enum class Moved { point, triangle };

/// This is a triangle with its corners on the grid.
struct GridTriangle {
  GridTriangle(const Vec3d& a, const Vec3d& b, const Vec3d& c);
  Vec3d corners[3];
  Vec3d normal;     ///< of twice its area
  double offset;    ///< of its plane, times the length of the normal
  double size;      ///< the largest component of a way from the first corner to another
  double rounding;  ///< of the normal's components

  /// Returns the height of a point above the plane, times the length of the normal; rounded.
  double height(const Vec3d& point) const { return dot(normal, point) - offset; }
  /// Returns whether a point at this height is above the plane. It is exact.
  bool isAbove(double height, const Vec3d& point, Moved moved) const {
    constexpr double kOfHeight = std::uint64_t{32} << kGridBits;
    return std::abs(height) > kOfHeight * rounding ? height > 0 : isAbove(point, moved);
  }

 private:
  bool isAbove(const Vec3d& point, Moved moved) const;
};

/// Says how the corners of a triangle lie to the plane of another one.
struct Corners {
  /// `moved` names the surface of the triangle.
  Corners(const GridTriangle& plane, const GridTriangle& triangle, Moved moved);

  double heights[3];  ///< above the plane, times the length of its normal; rounded
  unsigned above;     ///< a bit for each of those above it, exact
  int alone;          ///< this one lies on its own side, -1 if all lie on one

  bool isAbove(int corner) const { return (above >> corner & 1) != 0; }
  /// Returns the edge that leads from the corner that is alone, or to it. Edge k leads from corner k to the
  /// next.
  int edge(bool from_alone) const { return from_alone ? alone : previous(alone); }
  /// Returns the other corner of such an edge.
  int far(bool from_alone) const { return from_alone ? next(alone) : previous(alone); }

  static int next(int corner) { return corner < 2 ? corner + 1 : 0; }
  static int previous(int corner) { return corner > 0 ? corner - 1 : 2; }
};

/// The planes of t, of A, and u, of B, meet in a line, which two edges of each cross.
class EdgeOrder {
 public:
  EdgeOrder(const GridTriangle& t, const Corners& at_u, const GridTriangle& u, const Corners& at_t);
  /// Returns whether along the line, in the direction normal of t x normal of u, an edge of t comes before
  /// one of u. Each leads from or to the corner that is alone.
  bool comesBefore(bool from_alone_t, bool from_alone_u) const {
    const double volume = dot(t_.corners[at_u_.far(from_alone_t)] - alone_, to_u_[from_alone_u ? 1 : 0]);
    if (!(std::abs(volume) > rounding_)) return comesBeforeExactly(from_alone_t, from_alone_u);
    return (volume > 0) == (at_u_.isAbove(at_u_.alone) == at_t_.isAbove(at_t_.alone));
  }

 private:
  bool comesBeforeExactly(bool from_alone_t, bool from_alone_u) const;

  const GridTriangle &t_, &u_;
  const Corners &at_u_, &at_t_;
  Vec3d alone_;    ///< the corner of t
  Vec3d to_u_[2];  ///< cross products of the ways from there to both corners of an edge of u
  double rounding_;
};

/// Returns by how much a triangle adds to the winding number of a point: 1 where it is above it, in the
/// direction z, and faces up, -1 where it faces down, 0 elsewhere.
int windingBelow(const GridTriangle& triangle, const Vec3d& point, Moved moved);

inline Corners::Corners(const GridTriangle& plane, const GridTriangle& triangle, Moved moved) : above(0) {
  for (int k = 0; k < 3; ++k) {
    heights[k] = plane.height(triangle.corners[k]);
    above |= unsigned{plane.isAbove(heights[k], triangle.corners[k], moved)} << k;
  }
  constexpr std::int8_t kAlone[8] = {-1, 0, 1, 2, 2, 1, 0, -1};
  alone = kAlone[above];
}

}  // namespace innersphere
