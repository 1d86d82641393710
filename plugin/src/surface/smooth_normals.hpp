// Finds normals of a curved surface that was cut into triangles.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <LinearMath/btVector3.h>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/geometry.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Knows the normals of a surface. Neighbouring triangles that meet at less than 30 degrees are taken as one
/// curved surface if that bends on beyond at least one of them: its normal turns smoothly across them. Other
/// edges stay sharp, and flat faces exactly flat. All that is known of a triangle before a ray comes is kept
/// with it. Const members are safe to call from several threads at once.
class SmoothNormals {
 public:
  explicit SmoothNormals(const Surface& surface);

  /// Says where a line meets a triangle.
  struct Crossing {
    btScalar distance;                ///< [m] along the line, negative behind its start
    std::array<btScalar, 3> weights;  ///< of the triangle's corners, sum 1
  };
  /// Finds where a line meets a triangle. Returns false if it misses it. `direction` is a unit vector.
  bool cross(std::size_t triangle, const btVector3& from, const btVector3& direction,
             Crossing& crossing) const;
  /// Does the same for triangles near the given one, on the same side of sharp edges. Sets `triangle` to the
  /// one that is met.
  bool crossNear(std::size_t& triangle, const btVector3& from, const btVector3& direction,
                 Crossing& crossing) const;

  /// Describes the curved surface where a line crosses a triangle.
  struct Place {
    btVector3 normal;  ///< unit
    btScalar bulge;    ///< how far the curved surface stands out of the triangle there [m]
  };
  /// Returns the normal of the curved surface at a corner of a triangle.
  const btVector3& normalAt(std::size_t triangle, std::size_t corner) const {
    return facets_[triangle].normals[corner];
  }
  /// Returns the curved surface at a crossing.
  Place at(std::size_t triangle, const Crossing& crossing) const;
  /// Returns by how much the normal turns along a way of the length 1 on a triangle [1/m].
  btVector3 turn(std::size_t triangle, const btVector3& way) const;
  const btVector3* corners(std::size_t triangle) const { return facets_[triangle].corners; }
  /// Returns the normal of the triangle itself: unit, out of the solid. A sliver, which rounding would give
  /// any, has that of the face it lies on; zero if there is none.
  const btVector3& face(std::size_t triangle) const { return facets_[triangle].face; }
  btVector3 middle(std::size_t triangle) const {
    const Facet& facet = facets_[triangle];
    return (facet.corners[0] + facet.corners[1] + facet.corners[2]) / 3;
  }
  /// Returns true if an edge of a triangle, from a corner to the next, is sharp.
  bool isSharp(std::size_t triangle, std::size_t edge) const;
  /// Returns true if a sharp edge lies between a triangle and a point over its plane, not far away.
  bool isPastSharpEdge(std::size_t triangle, const btVector3& point) const;
  /// Names the sharp edge in which the surface ends.
  struct Ending {
    btScalar distance = BT_LARGE_FLOAT;  ///< [m]
    std::uint32_t triangle = 0;          ///< only if there is an edge
    std::uint32_t edge = 0;              ///< of the triangle's

    bool found() const { return distance < BT_LARGE_FLOAT; }
    bool isSameEdge(const Ending& other) const { return triangle == other.triangle && edge == other.edge; }
  };
  /// Returns the sharp edge that is met from a point of a triangle in a direction, no further than some
  /// triangles away.
  Ending untilSharpEdge(std::size_t triangle, const btVector3& point, const btVector3& towards) const;
  /// Says where a walk over the surface ends.
  struct Walked {
    btScalar share;          ///< of the way
    std::uint32_t triangle;  ///< that it ends in
    std::uint32_t edge;      ///< of the triangle's: the sharp one that is met; kNoEdge if none is
  };
  static constexpr std::uint32_t kNoEdge = 3;
  /// Walks from a point of a triangle along `way`, to its end or to a sharp edge. Returns false where the
  /// surface is not known, or if there are many triangles on the way. `most`: of the way, more than 1 if it
  /// goes on.
  bool walk(std::size_t triangle, const btVector3& point, const btVector3& way, btScalar most,
            Walked& walked) const;
  struct Ends {
    const btVector3& from;
    const btVector3& to;
  };
  /// Returns the ends of a sharp edge that was found.
  Ends endsOf(const Ending& ending) const;
  /// Returns true if the solid is hollow at a sharp edge that was found.
  bool isValley(const Ending& ending) const;
  struct EdgeFaces {
    btVector3 inwards[2];      ///< unit: along both faces, from the edge
    std::uint32_t id = 0;      ///< of the edge, the same from both
    std::uint32_t across = 0;  ///< the triangle beyond the edge
  };
  /// Returns how the faces of a sharp edge lie that was found.
  EdgeFaces facesOf(const Ending& ending) const;
  /// Returns the curvature of the surface across a triangle [1/m]: that along the edge which shows most of
  /// it. It is positive where the solid is convex, and exactly 0 where it is flat.
  btScalar curvature(std::size_t triangle) const { return facets_[triangle].curvature; }
  /// Returns true if the lines of a cone end at a vertex.
  bool isTip(std::uint32_t vertex) const { return std::binary_search(tips_.begin(), tips_.end(), vertex); }
  /// Returns true if a convex surface ends at a vertex: in such a tip, or in a sharp edge that juts out.
  bool isEnd(std::uint32_t vertex) const { return std::binary_search(ends_.begin(), ends_.end(), vertex); }
  /// Returns true if there is such a vertex.
  bool hasEnds() const { return !ends_.empty(); }

 private:
  /// This is a triangle. Its edge k goes from corner k to the next. What a line asks for first comes first.
  struct alignas(64) Facet {
    btVector3 corners[3];
    btVector3 face;           ///< unit; zero if there is none
    btVector3 inwards[3];     ///< along the triangle, from edge k; their products are weights [1/m]
    std::uint32_t across[3];  ///< triangles beyond the edges; see kSharp
    /// How many edges lead across a sharp one, at least; it is a few more than were looked at if none is
    /// near.
    std::uint32_t to_sharp;
    btVector3 normals[3];  ///< of the curved surface at the corners
    btScalar bulges[3];    ///< of the edges, at weights of 1 of both ends [m]
    btScalar curvature;
  };
  using Around = std::vector<std::vector<std::uint32_t>>;  ///< the triangles around each vertex
  void setCorners(const Surface& surface);
  static void setFace(const btVector3& face, Facet& facet);
  void layOnNeighbours(const Surface& surface, const Around& around);
  static bool isSmooth(const Facet& a, const Facet& b);
  btVector3 normalAt(const Surface& surface, const std::vector<std::uint32_t>& around, std::uint32_t corner,
                     const Facet& facet) const;
  void setAcross(const Surface& surface, const Around& around);
  /// Says whether the surface, beyond a triangle at an edge of which it bends, bends on: in the same sense,
  /// and about as much. `none`: it does not bend there, or nothing can be told.
  enum class Bend { none, ends, goes_on };
  Bend bendBeyond(std::size_t triangle, std::size_t edge) const;
  void findFolds(const Surface& surface, const Around& around);
  std::vector<std::uint32_t> fanOf(std::uint32_t triangle, const std::vector<std::uint32_t>& around) const;
  bool isTip(const Surface& surface, const std::vector<std::uint32_t>& around, std::uint32_t triangle,
             std::size_t corner) const;
  void setNormals(const Surface& surface, const Around& around);
  void setMixed(const Surface& surface, const Around& around);
  void setEnds(const Surface& surface);
  void countToSharp();
  struct Exit {
    std::size_t edge;  ///< 3 if there is none
    btScalar time;     ///< of the way
  };
  static Exit exitOf(const Facet& facet, const btVector3& at, const btVector3& along);
  static bool crossPlane(const Facet& facet, const btVector3& from, const btVector3& direction,
                         Crossing& crossing);

  std::vector<Facet> facets_;
  std::vector<std::uint32_t> tips_, ends_;  ///< sorted
  /// By how much normals turn aside in the middle of each edge of a triangle, at weights of 1 of both ends.
  std::vector<std::array<btVector3, 3>> mixed_;
};

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
