// Declares a bounding volume tree over the triangles of a closed surface.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "innersphere/geometry.hpp"

namespace innersphere {

/// Returns whether each edge is run along as often in one direction as in the other.
bool isClosedSurface(const Surface& surface);

/// Holds the triangles of a surface, in the order of the leaves of a tree of boxes.
class SurfaceTree {
 public:
  /// Throws Error: empty_input if there are no triangles, not_a_solid if they are not closed: an edge is not
  /// run along as often in one direction as in the other.
  explicit SurfaceTree(const Surface& surface);

  using Triangle = std::array<Vec3f, 3>;
  static constexpr std::uint32_t kLeafTriangles = 4;

  /// One number of each of a node's children lies side by side: one instruction looks at several of them.
  static constexpr std::size_t kWidth = 4;
  using Lanes = double __attribute__((vector_size(kWidth * sizeof(double))));

  struct Child {
    std::uint32_t first = 0;  ///< triangle of a leaf, or number of a node
    std::uint32_t count = 0;  ///< triangles of a leaf, or 0
    bool isLeaf() const { return count > 0; }
  };
  struct Node {
    Lanes centre[3], half[3];  ///< of the children's boxes; of a child that is none half is below zero
    std::array<Child, kWidth> children;
  };

  /// The root is the first one.
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const Bounds& bounds() const { return bounds_; }

 private:
  std::uint32_t build(std::uint32_t first, std::uint32_t end);
  std::uint32_t halve(std::uint32_t first, std::uint32_t end);
  Bounds boundsOf(std::uint32_t first, std::uint32_t end) const;

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
  Bounds bounds_;
};

}  // namespace innersphere
