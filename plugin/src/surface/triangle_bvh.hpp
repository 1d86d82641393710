// Holds the triangles of a solid's surface in a bounding volume tree.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <LinearMath/btVector3.h>

#include "innersphere/bullet_precision.hpp"
#include "innersphere/geometry.hpp"
#include "surface/lanes.hpp"

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
  using Lanes = FourFloats;
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
    std::uint32_t used;  ///< a bit for each
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
  static float roundedUp(btScalar x) {
    const auto rounded = static_cast<float>(x);
    return rounded < x ? std::nextafter(rounded, kFar) : rounded;
  }
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
    float distance;
  };
  std::array<Entry, (kWidth - 1) * kMaxDepth + 1> open;
  std::size_t count = 0;
  Entry next{{0, false}, 0};
  float limit = roundedUp(farthest);
  const auto takeOpen = [&] {
    while (count > 0) {
      next = open[--count];
      if (next.distance <= limit) return true;
    }
    return false;
  };
  // Always on with the nearest child. The others stay open, the nearest of them on top.
  const auto goToLeaf = [&] {
    while (!next.child.is_leaf) {
      const Node& node = nodes_[next.child.index];
      const Lanes distances = bound(node.boxes);
      unsigned near = signBits(distances <= limit);
      if (near == 0) return false;
      const auto takeLast = [&] {
        const auto k = static_cast<std::size_t>(std::bit_width(near) - 1);
        near ^= 1u << k;
        return Entry{node.children[k], distances[k]};
      };
      const std::size_t bottom = count;
      next = takeLast();
      while (near != 0) {
        Entry other = takeLast();
        if (!(next.distance < other.distance)) std::swap(other, next);
        std::size_t at = count++;
        for (; at > bottom && open[at - 1].distance < other.distance; --at) open[at] = open[at - 1];
        open[at] = other;
      }
    }
    return true;
  };
  for (bool more = !nodes_.empty(); more; more = takeOpen()) {
    if (!goToLeaf()) continue;
    const Leaf& leaf = leaves_[next.child.index];
    const Lanes distances = bound(leaf);
    for (unsigned near = signBits(distances <= limit) & leaf.used; near != 0; near &= near - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(near));
      if (distances[k] <= limit) limit = roundedUp(visit(leaf.triangles[k]));
    }
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
