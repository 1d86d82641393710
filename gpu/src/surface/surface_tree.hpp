// Declares a bounding volume tree over the triangles of a closed surface.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "innersphere/geometry.hpp"

namespace innersphere {

/// Holds the triangles of a surface, in the order of the leaves of a binary tree of boxes.
class SurfaceTree {
 public:
  /// Throws Error: empty_input if there are no triangles, not_a_solid if they are not closed: an edge is not
  /// run along as often in one direction as in the other.
  explicit SurfaceTree(const Surface& surface);

  using Triangle = std::array<Vec3f, 3>;
  static constexpr std::uint32_t kLeafTriangles = 4;

  struct Node {
    Vec3d centre, half;    ///< of its box
    std::uint32_t first;   ///< triangle of a leaf, or second child of an inner node; the first one is next
    std::uint32_t count;   ///< triangles of a leaf, or 0
    bool isLeaf() const { return count > 0; }
  };

  /// The root is the first one.
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  void build(std::uint32_t first, std::uint32_t end);

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace innersphere
