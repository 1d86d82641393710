// Declares a surface that stands somewhere, with its vertices rounded to a grid.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/mat3.hpp"
#include "surface/sides.hpp"
#include "surface/surface_tree.hpp"

namespace innersphere {

/// Turns, scales and moves: x -> matrix * x + translation. The matrix is a rotation times a number above
/// zero.
struct Similarity {
  core::Mat3<double> matrix;
  Vec3d translation;

  double scale() const;
  Similarity inverse() const;
  Vec3d operator()(const Vec3d& x) const { return matrix * x + translation; }
};

/// Returns first b, then a.
Similarity after(const Similarity& a, const Similarity& b);

/// Holds the boxes of a node's children: on the coarse grid of the first surface, then on that of the second
/// one. Half of a number is the high side, half minus the low one, in an order that differs between the
/// surfaces: boxes of both meet if the sums of all halves are not negative.
struct LaneBoxes {
  using Halves = std::int16_t __attribute__((vector_size(sizeof(FourInts))));
  FourInts sides[6];

  /// Returns which of the boxes meet four times the same one of the other surface, a bit for each, on the
  /// grid of the first.
  std::uint32_t meeting(const FourInts (&box)[3]) const {
    Halves gaps{};
    for (int k = 0; k < 3; ++k) {
      const FourInts there = box[k];
      gaps |= reinterpret_cast<Halves>(sides[k]) + reinterpret_cast<Halves>(there);
    }
    const auto gap = reinterpret_cast<FourInts>(gaps);
    return ~signBits(gap | (gap << 16)) & 15;
  }
};

/// Leads from a surface to the coarse grid of the other one. Each number is there four times: for all
/// children of a node.
struct ToCoarseGrid {
  FourFloats matrix[3][4]{}, absolute[3][4]{};  ///< column after column; in the last row zeros
  FourFloats translation[4]{};
  float slack;  ///< what rounding may do to places there
};

/// Here the other surface crosses an edge of a triangle.
struct Crossing {
  Vec3d at;
  int change;          ///< of the winding number in the other solid
  std::uint32_t next;  ///< of the same edge, 0 if there is no other
};

/// In this part of a line a triangle meets one of the other surface. What is in the other solid lies to the
/// left, seen from outside of the triangle's own one.
struct Segment {
  Vec3d from, to;
  std::uint32_t own;    ///< the triangle, in the tree
  std::uint32_t other;  ///< where that of the other surface is
  std::uint32_t next;   ///< of the same triangle
};

/// Holds one of two surfaces, in the frame of the first one, in cells of a grid. Nodes and triangles are
/// placed when they are first asked for. Memory is kept from query to query.
class GridSurface {
 public:
  using Index = std::uint32_t;
  static constexpr Index kNone = std::numeric_limits<Index>::max();

  /// This is a triangle, and where the other surface meets it.
  struct Triangle : GridTriangle {
    Triangle(const SurfaceTree::Triangle& v, Index i) : vertices(v), index(i) {}
    SurfaceTree::Triangle vertices;
    Index index;  ///< in the tree
    Index first_segment = kNone;
    std::array<Index, 3>
        first_crossings{};         ///< of the edges from each corner to the next, 0 if there is none
    std::array<int, 3> changes{};  ///< of the winding number in the other solid along these edges
  };

  struct Node : LaneBoxes, SurfaceTree::Links {
    Index query = 0;  ///< in which it was placed
  };

  /// Begins a query. `placed`: in the frame of the first surface; `in_other`: in that of the other one;
  /// `cells` of the grid for a unit of length; `moved`: what the points of the other surface are asked for;
  /// `wide`: with AVX-512.
  void begin(const SurfaceTree& tree, const SurfaceTree& other, const Similarity& placed,
             const Similarity& in_other, double cells, Moved moved, bool wide);

  bool isWide() const { return wide_; }

  const SurfaceTree& tree() const { return *tree_; }
  /// Returns the place of a vertex on the grid.
  Vec3d vertex(Index v) const;
  /// Finds those of a triangle's corners.
  void placeCorners(const SurfaceTree::Triangle& v, CornerPlaces& corners) const;
  /// Returns the place of a triangle among those that were asked for.
  Index find(Index triangle) {
    if (marks_[triangle].query != query_) placeTriangle(triangle);
    return marks_[triangle].place;
  }
  Triangle& at(Index place) { return triangles_[place]; }

  const Node& node(Index index) {
    if (nodes_[index].query != query_) placeNode(index);
    return nodes_[index];
  }

  void addSegment(Triangle& t, const Vec3d& from, const Vec3d& to, Index other) {
    segments_.push_back({from, to, t.index, other, t.first_segment});
    t.first_segment = static_cast<Index>(segments_.size() - 1);
  }
  void addCrossing(Triangle& t, const Vec3d& at, int edge, int change) {
    crossings_.push_back({at, change, t.first_crossings[edge]});
    t.first_crossings[edge] = static_cast<Index>(crossings_.size() - 1);
    t.changes[edge] += change;
  }
  const std::vector<Segment>& segments() const { return segments_; }
  /// The first one is none.
  const std::vector<Crossing>& crossings() const { return crossings_; }

  /// Returns how often the surface encloses a point of the other one.
  int windingAt(const Vec3d& point);

 private:
  struct Mark {
    Index query = 0, place = 0;
    Index asked = 0;  ///< number of the last point for which it was looked at
  };

  template <class Kernels>
  struct Placing;
  struct WidePlacing;

  void placeTriangle(Index triangle);
  void placeNode(Index index);

  const SurfaceTree *tree_ = nullptr, *other_ = nullptr;
  Similarity to_grid_;
  ToCoarseGrid to_other_;
  bool wide_ = false;
  double cells_;
  Moved moved_;
  Index query_ = 0, asked_ = 0;
  std::vector<Node> nodes_;
  std::vector<Mark> marks_;
  std::vector<Triangle> triangles_;
  std::vector<Segment> segments_;
  std::vector<Crossing> crossings_;
  std::vector<Index> open_;
};

}  // namespace innersphere
