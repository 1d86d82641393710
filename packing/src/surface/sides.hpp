// Declares on which side of each other points, edges and triangles lie, decided exactly.
#pragma once

#include <cstdint>
#include <cstring>

#include "innersphere/geometry.hpp"
#include "surface/lanes.hpp"

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
  double places[3][5];  ///< along each axis those of all corners, and of the first two again
  Vec3d normal;         ///< of twice its area
  double offset;        ///< of its plane, times the length of the normal
  double size;          ///< the largest component of a way from the first corner to another
  double rounding;      ///< of the normal's components

  Vec3d corner(int k) const { return {places[0][k], places[1][k], places[2][k]}; }
  /// Returns heights above the plane, times the length of the normal; rounded by up to heightRounding().
  template <typename T>
  T height(const T& x, const T& y, const T& z) const {
    return normal.x * x + normal.y * y + normal.z * z - offset;
  }
  /// That of the normal, and of products with places, which are not seen from the plane.
  double heightRounding() const { return static_cast<double>(std::uint64_t{32} << kGridBits) * rounding; }
  /// Returns whether a point is above the plane, exactly.
  bool isAbove(const Vec3d& point, Moved moved) const;
};

/// Says how the corners of a triangle lie to the plane of another one.
struct Corners {
  /// `moved` names the surface of the triangle.
  Corners(const GridTriangle& plane, const GridTriangle& triangle, Moved moved);

  double heights[4];  ///< above the plane, times the length of its normal; rounded
  unsigned above;     ///< a bit for each of those above it, exact
  int alone;          ///< this one lies on its own side, -1 if all lie on one

  bool isAbove(int corner) const { return (above >> corner & 1) != 0; }
  /// Returns the edge that leads from the corner that is alone, or to it. Edge k leads from corner k to the
  /// next.
  int edge(bool from_alone) const { return from_alone ? alone : previous(alone); }
  /// Returns the other corner of such an edge.
  int far(bool from_alone) const { return from_alone ? next(alone) : previous(alone); }

  static constexpr std::int8_t kAlone[8] = {-1, 0, 1, 2, 2, 1, 0, -1};  ///< by `above`
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
    return (before_ >> bit(from_alone_t, from_alone_u) & 1) != 0;
  }

 private:
  /// The first two bits are of edges that both lead from those corners, or to them.
  static int bit(bool from_alone_t, bool from_alone_u) {
    return (from_alone_t == from_alone_u ? 0 : 2) + (from_alone_u ? 0 : 1);
  }
  unsigned before_;
};

/// Returns by how much a triangle adds to the winding number of a point: 1 where it is above it, in the
/// direction z, and faces up, -1 where it faces down, 0 elsewhere.
int windingBelow(const GridTriangle& triangle, const Vec3d& point, Moved moved);

inline Corners::Corners(const GridTriangle& plane, const GridTriangle& triangle, Moved moved) : above(0) {
  unsigned below = 0;
  const double rounding = plane.heightRounding();
  for (const int k : {0, 2}) {
    const auto& at = triangle.places;
    const TwoDoubles height = plane.height(twoAt(at[0] + k), twoAt(at[1] + k), twoAt(at[2] + k));
    std::memcpy(heights + k, &height, sizeof height);
    above |= bitsAbove(height, rounding) << k;
    below |= bitsAbove(-height, rounding) << k;
  }
  above &= 7;
  if (((above | below) & 7) != 7) {
    for (int k = 0; k < 3; ++k) {
      if (((above | below) >> k & 1) == 0 && plane.isAbove(triangle.corner(k), moved)) above |= 1U << k;
    }
  }
  alone = kAlone[above];
}

}  // namespace innersphere
