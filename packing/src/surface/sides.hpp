// Declares on which side of each other points, edges and triangles lie, decided exactly.
#pragma once

#include <cstdint>

#include "innersphere/geometry.hpp"
#include "surface/box.hpp"

namespace innersphere {

// All corners lie on a grid: their coordinates are whole numbers. So a sign can be computed without rounding,
// which is done where double precision does not decide. Of two surfaces the second one, B, is moved by an
// infinitely small d = (e, e^2, e^3): then no sign is zero, and all fit together, as they are those of real
// surfaces. What is continuous, such as the volume that both share, does not notice.

/// Coordinates are at most 2^kGridBits. Then six times the product of three differences is less than 2^127.
constexpr int kGridBits = 39;

/// A bound of rounding, of one difference of two products.
constexpr double kRounding2 = 4 * 0x1p-53;
/// That of a sum of three products of differences.
constexpr double kVolumeRounding = 32 * 0x1p-53;

/// Says which of two surfaces is the one that is moved.
enum class Moved { point, triangle };

/// Holds the places of a triangle's corners on the grid.
struct CornerPlaces {
  static constexpr int kRow = 4;
  /// Along each axis those of all corners, and of the first one again.
  alignas(kRow * sizeof(double)) double places[3][kRow];

  Vec3d corner(int k) const { return {places[0][k], places[1][k], places[2][k]}; }
};

/// This is a triangle with its corners on the grid.
struct GridTriangle : CornerPlaces {
  /// Finds all that follows from the places.
  void findPlane();
  Vec3d normal;     ///< of twice its area
  double offset;    ///< of its plane, times the length of the normal
  double size;      ///< the largest component of a way from the first corner to another
  double rounding;  ///< of the normal's components

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

inline void GridTriangle::findPlane() {
  const Vec3d a = corner(0), to_b = corner(1) - a, to_c = corner(2) - a;
  const double size_b = largest(to_b), size_c = largest(to_c);
  normal = cross(to_b, to_c);
  offset = dot(normal, a);
  size = std::max(size_b, size_c);
  rounding = kRounding2 * size_b * size_c;
}

/// Says how the corners of a triangle lie to the plane of another one.
struct Corners {
  std::uint8_t above;  ///< a bit for each of those above the plane, exact
  std::int8_t alone;   ///< this one lies on its own side, -1 if all lie on one

  bool isAbove(int corner) const { return (above >> corner & 1) != 0; }
  /// Returns the edge that leads from the corner that is alone, or to it. Edge k leads from corner k to the
  /// next.
  int edge(bool from_alone) const { return turned(alone, from_alone ? 0 : 2); }
  /// Returns the other corner of such an edge.
  int far(bool from_alone) const { return turned(alone, from_alone ? 1 : 2); }

  static constexpr std::int8_t kAlone[8] = {-1, 0, 1, 2, 2, 1, 0, -1};  ///< by `above`
  // From a table: no processor foresees which corner it is.
  static constexpr std::int8_t kTurned[5] = {0, 1, 2, 0, 1};
  static int turned(int corner, int by) { return kTurned[corner + by]; }
  static int next(int corner) { return turned(corner, 1); }
  static int previous(int corner) { return turned(corner, 2); }
};

/// `moved` names the surface of the triangle.
template <class Kernels>
Corners cornersAt(const GridTriangle& plane, const GridTriangle& triangle, Moved moved) {
  const unsigned sides = Kernels::sides(plane, triangle);
  unsigned above = sides & 7;
  if (((sides | sides >> 4) & 7) != 7) {
    for (int k = 0; k < 3; ++k) {
      if (((sides | sides >> 4) >> k & 1) == 0 && plane.isAbove(triangle.corner(k), moved)) above |= 1U << k;
    }
  }
  return {static_cast<std::uint8_t>(above), Corners::kAlone[above]};
}

/// The planes of t, of A, and u, of B, meet in a line, which two edges of each cross.
class EdgeOrder {
 public:
  template <class Kernels>
  static EdgeOrder of(const GridTriangle& t, const Corners& at_u, const GridTriangle& u, const Corners& at_t);
  /// Returns whether along the line, in the direction normal of t x normal of u, an edge of t comes before
  /// one of u. Each leads from or to the corner that is alone.
  bool comesBefore(bool from_alone_t, bool from_alone_u) const {
    return (before_ >> bit(from_alone_t, from_alone_u) & 1) != 0;
  }

 private:
  /// The first two bits are of edges that both lead from those corners, or to them.
  static int bit(bool from_alone_t, bool from_alone_u) {
    return 2 * static_cast<int>(from_alone_t != from_alone_u) + static_cast<int>(!from_alone_u);
  }
  /// Adds the signs that are not in `known`, exactly.
  void decide(const GridTriangle& t, const Corners& at_u, const GridTriangle& u, const Corners& at_t,
              unsigned known);

  std::uint8_t before_;
};

template <class Kernels>
EdgeOrder EdgeOrder::of(const GridTriangle& t, const Corners& at_u, const GridTriangle& u,
                        const Corners& at_t) {
  // The signs of the volumes between both edges, seen from the corner of t that is alone.
  const Vec3d from = t.corner(at_u.alone), to_alone = u.corner(at_t.alone) - from;
  // No way from a corner of t to one of u is longer; and an edge between the others is up to twice the size.
  const double farthest = largest(u.corner(0) - t.corner(0)) + t.size + u.size;
  const double rounding = kVolumeRounding * 2 * t.size * farthest * farthest;
  const unsigned volumes = Kernels::volumes(from, to_alone, t.places[0] + Corners::next(at_u.alone),
                                            u.places[0] + Corners::next(at_t.alone), rounding);
  const bool same = at_u.isAbove(at_u.alone) == at_t.isAbove(at_t.alone);
  const unsigned known = (volumes | volumes >> 4) & 15;
  EdgeOrder order;
  order.before_ = static_cast<std::uint8_t>((same ? volumes : volumes >> 4) & 15);
  if (known != 15) order.decide(t, at_u, u, at_t, known);
  return order;
}

/// Returns by how much a triangle adds to the winding number of a point from which one looks along z, up or
/// down: 1 where one sees the inner side of it, -1 where the outer one, 0 elsewhere.
int windingSeen(const GridTriangle& triangle, const Vec3d& point, Moved moved, bool up);

}  // namespace innersphere
