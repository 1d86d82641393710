// Declares a bounding volume tree over the triangles of a closed surface.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "innersphere/geometry.hpp"
#include "surface/lanes.hpp"

namespace innersphere {

/// What rounding to single precision may do to a place, by the largest coordinate.
constexpr double kSingleRounding = 2e-6;

/// Holds a closed surface: its triangles, a tree of boxes, and which triangles are neighbours.
class SurfaceTree {
 public:
  using Triangle = std::array<std::uint32_t, 3>;  ///< indices of vertices

  /// Throws Error: empty_input if there are no triangles, not_a_solid if they are not closed: an edge is not
  /// run along as often in one direction as in the other.
  explicit SurfaceTree(const Surface& surface);
  /// Returns nothing where that would throw.
  static std::optional<SurfaceTree> ifClosed(const Surface& surface);

  /// One number of each of a node's children lies side by side: one instruction looks at all of them.
  static constexpr std::uint32_t kWidth = 4;
  using Lanes = FourFloats;

  /// Says what is below a node.
  struct Links {
    std::array<std::uint32_t, kWidth> children{};
    std::uint8_t count = 0;      ///< of the children
    bool are_triangles = false;  ///< or nodes
  };
  struct Node : Links {
    std::uint8_t corners = 0;  ///< 3 or 4, of triangles, or of parts of them
    FourInts sides[3]{};       ///< of the children's boxes in the coarse grid
    /// Three numbers for each corner of the children if they are triangles; those for centre and half size of
    /// their boxes if they are nodes.
    Lanes extent[12]{};
  };

  /// Boxes are compared on a grid so coarse that its numbers have 15 bits.
  struct CoarseGrid {
    Vec3d middle{};                       ///< of the surface
    double per = 0;                       ///< cells for a unit of length
    static constexpr float kEnd = 16300;  ///< behind all of the surface: boxes reach no farther
    /// The sides of what is behind the end of any grid.
    static constexpr std::int32_t kNoBox = -16384 * 0x10001;
    /// Returns the high sides of boxes, and minus their low ones, in the halves of a number. They are
    /// rounded up.
    static FourInts sides(Lanes high, Lanes minus_low);
  };

  /// The root is the first one. Triangles and vertices have other numbers than in the given surface.
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const std::vector<Lanes>& vertices() const { return vertices_; }
  const Bounds& bounds() const { return bounds_; }
  const CoarseGrid& grid() const { return grid_; }

  /// Edge 4 t + k of the surface leads from corner k of triangle t to the next one. Returns for the edges of
  /// a triangle those that run the other way, of its neighbours.
  const std::array<std::uint32_t, 4>& twins(std::uint32_t triangle) const { return twins_[triangle]; }

  /// Parts of the surface that have no edge in common.
  std::uint32_t partCount() const { return static_cast<std::uint32_t>(triangle_of_part_.size()); }
  std::uint32_t triangleOfPart(std::uint32_t part) const { return triangle_of_part_[part]; }
  std::uint32_t partOf(std::uint32_t triangle) const { return parts_.empty() ? 0 : parts_[triangle]; }

 private:
  class Builder;
  using Twins = std::vector<std::array<std::uint32_t, 4>>;
  SurfaceTree(const Surface& surface, Twins twins);
  /// Returns no twins if the surface is not closed. Where more than two triangles meet in an edge, any two of
  /// opposite directions are neighbours.
  static Twins findTwins(const Surface& surface);
  void addBoxes(Node& node, const Bounds* boxes) const;
  /// Numbers triangles and vertices as the tree has them: neighbours then lie close by in memory.
  void sortAsInTree();
  void findParts();

  std::vector<Lanes> vertices_;  ///< the last number is zero
  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
  Twins twins_;
  std::vector<std::uint32_t> triangle_of_part_, parts_;  ///< parts_ is empty if there is one
  Bounds bounds_;
  CoarseGrid grid_;
};

inline FourInts SurfaceTree::CoarseGrid::sides(Lanes high, Lanes minus_low) {
  const Lanes last = Lanes{} + kEnd;
  // What is not a number is at the end, too.
  const auto up = [&](Lanes x) {
    return __builtin_convertvector(larger(lesser(x + 1, last), -last), FourInts);
  };
  return (up(high) << 16) | (up(minus_low) & 0xffff);
}

}  // namespace innersphere
