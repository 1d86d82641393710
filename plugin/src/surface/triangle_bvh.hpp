// Holds the triangles of a solid's surface in a bounding volume tree.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <LinearMath/btVector3.h>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/geometry.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {

/// Stands for the distance of what a search does not meet.
constexpr float kFar = std::numeric_limits<float>::infinity();

/// This is a tree of boxes in the surface's frame, which one walk searches: for the first triangle on a ray,
/// the nearest to a point, or all in a box. Const members are safe to call from several threads at once.
class TriangleBvh {
 public:
  explicit TriangleBvh(const Surface& surface);

  /// One number of each of a node's children lies side by side: one instruction looks at all of them.
  static constexpr std::size_t kWidth = 4;
  using Lanes = float __attribute__((vector_size(kWidth * sizeof(float))));
  static Lanes lesser(Lanes a, Lanes b) { return a < b ? a : b; }
  static Lanes greater(Lanes a, Lanes b) { return a > b ? a : b; }
  struct Boxes {
    Lanes min[3], max[3];  ///< x, y, z
  };
  /// The places x with normal . x = offset.
  struct Planes {
    Lanes normal[3], offset;  ///< unit
    /// Returns how far a place is in front of each.
    Lanes heightsOf(const Lanes (&at)[3]) const {
      return normal[0] * at[0] + normal[1] * at[1] + normal[2] * at[2] - offset;
    }
  };
  /// Holds neighbouring triangles. Normals of those without area are 0.
  struct Leaf {
    Planes faces;     ///< theirs
    Planes edges[3];  ///< along them and upright on the faces; triangles are in front
    /// A line meets no triangle where its height above an edge is less than this [m].
    Lanes lowest;
    std::array<std::uint32_t, kWidth> triangles;
    std::uint32_t count;
  };
  /// Returns how far off heights over planes may be, for rounding [m].
  float rounding() const { return rounding_; }

  /// Visits triangles, those in nearer boxes first. bound(boxes) and bound(leaf) tell in Lanes how far away
  /// the triangles in each box, and those of a leaf, are at least. visit(triangle) returns how far away
  /// further ones may be to be visited still; `farthest` is how far away the first ones may be. Distances may
  /// have any unit.
  template <typename Bound, typename Visit>
  void search(btScalar farthest, const Bound& bound, const Visit& visit) const;

 private:
  struct Child {
    std::uint32_t index;  ///< of its leaf or its node
    bool is_leaf;
  };
  struct Node {
    Boxes boxes;
    std::array<Child, kWidth> children;
  };
  /// Children are of equal size, so that no tree is deeper.
  static constexpr std::size_t kMaxDepth = 16;

  std::uint32_t build(const Surface& surface, std::size_t first, std::size_t end);
  std::uint32_t appendLeaf(const Surface& surface, std::size_t first, std::size_t end);
  std::size_t halve(const Surface& surface, std::size_t first, std::size_t end);
  void enclose(const Surface& surface, std::size_t first, std::size_t end, std::size_t child,
               Boxes& boxes) const;

  float rounding_;
  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
  std::vector<std::uint32_t> triangles_;  ///< in order; only while it is built
};

template <typename Bound, typename Visit>
void TriangleBvh::search(btScalar farthest, const Bound& bound, const Visit& visit) const {
  struct Entry {
    Child child;
    btScalar distance;
  };
  std::array<Entry, (kWidth - 1) * kMaxDepth + 1> stack;
  std::size_t count = 0;
  if (!nodes_.empty()) stack[count++] = {{0, false}, 0};
  while (count > 0) {
    const Entry entry = stack[--count];
    if (!(entry.distance <= farthest)) continue;
    if (entry.child.is_leaf) {
      const Leaf& leaf = leaves_[entry.child.index];
      const Lanes distances = bound(leaf);
      for (std::uint32_t k = 0; k < leaf.count; ++k) {
        if (distances[k] <= farthest) farthest = visit(leaf.triangles[k]);
      }
      continue;
    }
    const Node& node = nodes_[entry.child.index];
    const Lanes distances = bound(node.boxes);
    const std::size_t bottom = count;
    for (std::size_t k = kWidth; k-- > 0;) {
      if (!(distances[k] <= farthest)) continue;
      // The nearest is on top.
      std::size_t at = count++;
      for (; at > bottom && stack[at - 1].distance < distances[k]; --at) stack[at] = stack[at - 1];
      stack[at] = {node.children[k], btScalar(distances[k])};
    }
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
