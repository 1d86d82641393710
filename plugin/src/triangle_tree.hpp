// Triangles of a solid's surface in a bounding volume tree.
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

/// A binary tree of boxes in the surface's frame, which one walk searches: for the first triangle on a ray,
/// the nearest to a point, or all in a box. Const members are safe to call from several threads at once.
class TriangleTree {
 public:
  explicit TriangleTree(const Surface& surface);

  struct Box {
    std::array<float, 3> min, max;
  };
  /// Visits triangles, those in nearer boxes first. bound(box) is how far away the triangles in a box are at
  /// least, visit(triangle) returns how far away further ones may be to be visited still; `farthest`: the
  /// first ones. Distances in any unit.
  template <typename Bound, typename Visit>
  void search(btScalar farthest, const Bound& bound, const Visit& visit) const;

 private:
  /// Nodes follow their parents: the first child at once, the second where the parent says.
  struct Node {
    Box box;
    std::uint32_t first;  ///< of its triangles, or its second child
    std::uint32_t count;  ///< of triangles; 0 if it has children
  };
  /// Halves are of equal size, so that no tree is deeper.
  static constexpr std::size_t kMaxDepth = 32;

  void build(const Surface& surface, std::size_t first, std::size_t end);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> triangles_;
};

template <typename Bound, typename Visit>
void TriangleTree::search(btScalar farthest, const Bound& bound, const Visit& visit) const {
  struct Entry {
    std::uint32_t node;
    btScalar distance;
  };
  std::array<Entry, kMaxDepth + 1> stack;
  std::size_t count = 0;
  if (!nodes_.empty()) stack[count++] = {0, bound(nodes_[0].box)};
  while (count > 0) {
    const Entry entry = stack[--count];
    if (!(entry.distance <= farthest)) continue;
    const Node& node = nodes_[entry.node];
    if (node.count > 0) {
      for (std::uint32_t i = 0; i < node.count; ++i) farthest = visit(triangles_[node.first + i]);
      continue;
    }
    Entry near{entry.node + 1, bound(nodes_[entry.node + 1].box)};
    Entry far{node.first, bound(nodes_[node.first].box)};
    if (far.distance < near.distance) std::swap(near, far);
    if (far.distance <= farthest) stack[count++] = far;
    if (near.distance <= farthest) stack[count++] = near;
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
