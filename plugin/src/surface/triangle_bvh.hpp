// Holds the triangles of a solid's surface in a bounding volume tree.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
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
  using Integers = FourInts;
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

  /// Visits triangles, those in nearer boxes first, and of boxes that are equally near always the same one.
  /// bound(boxes) and bound(leaf) tell in Lanes how far away the triangles in each box, and those of a leaf,
  /// are at least: no box is nearer than one around it. visit(triangle) returns how far away further ones may
  /// be to be visited still; `farthest` is how far away the first ones may be. Distances may have any unit.
  template <typename Bound, typename Visit>
  void search(btScalar farthest, const Bound& bound, const Visit& visit) const;

 private:
  static float roundedUp(btScalar x) {
    const auto rounded = static_cast<float>(x);
    return rounded < x ? std::nextafter(rounded, kFar) : rounded;
  }
  /// Holds a child's number in its node in two bits, then kLeaf if it is one, then its index among all leaves
  /// or nodes.
  using Child = std::uint32_t;
  static constexpr Child kLeaf = Child(1) << 29;
  static constexpr int kNumberShift = 30;
  /// A child that is to be looked at: its distance, which is not negative, then the child. So these are in
  /// the order of distances, and children of a node that are as far as each other in theirs.
  using Open = std::uint64_t;
  static constexpr int kDistanceShift = 32;
  struct Node {
    Boxes boxes;
    Integers children;
  };
  /// Children are of equal size, so that no tree is deeper.
  static constexpr std::size_t kMaxDepth = 16;
  /// Of each depth, children of two nodes may be open, but for the two that are looked at.
  static constexpr std::size_t kMostOpen = 2 * (kWidth - 1) * kMaxDepth + 1;

  /// Writes the near ones of a node's children before those that are open, the nearest one first, and before
  /// them what is not open. Returns how many are near.
  static std::size_t openNear(const Integers& near, const Lanes& distances, const Integers& children,
                              Open* before);
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

inline std::size_t TriangleBvh::openNear(const Integers& near, const Lanes& distances,
                                         const Integers& children, Open* before) {
  static_assert(kWidth == 4);
  // What is far becomes 0, which comes first; -0 would come last.
  const Integers near_distances = reinterpret_cast<Integers>(distances + 0.0F) & near;
  const Integers near_children = children & near;
  std::uint32_t high[kWidth], low[kWidth];
  std::memcpy(high, &near_distances, sizeof high);
  std::memcpy(low, &near_children, sizeof low);
  Open all[kWidth];
  for (std::size_t k = 0; k < kWidth; ++k) all[k] = Open(high[k]) << kDistanceShift | low[k];
  // A network without branches, which no processor would foresee.
  const auto sort = [&](std::size_t i, std::size_t j) {
    const Open change = (all[i] ^ all[j]) & (0 - Open(all[j] < all[i]));
    all[i] ^= change;
    all[j] ^= change;
  };
  sort(0, 1);
  sort(2, 3);
  sort(0, 2);
  sort(1, 3);
  sort(1, 2);
  std::memcpy(before - kWidth, all, sizeof all);
  constexpr std::uint64_t kCounts = 0x4332322132212110;  // of the bits in each digit
  return kCounts >> 4 * signBits(near) & 7;
}

template <typename Bound, typename Visit>
void TriangleBvh::search(btScalar farthest, const Bound& bound, const Visit& visit) const {
  std::array<Open, kMostOpen + kWidth> open;  // from `first` on; before it there is room for far ones
  std::size_t first = open.size();
  float limit = roundedUp(farthest);
  const auto isNear = [&](Open item) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(item >> kDistanceShift)) <= limit;
  };
  const auto isLeaf = [](Open item) { return (item & kLeaf) != 0; };
  const auto indexOf = [](Open item) { return static_cast<std::uint32_t>(item) & (kLeaf - 1); };
  if (!nodes_.empty()) open[--first] = 0;
  while (first < open.size()) {
    const Open next = open[first++];
    if (!isNear(next)) continue;
    // Two of a kind are looked at side by side, for each is a long chain of steps. They stay in their order.
    const bool two = first < open.size() && isLeaf(open[first]) == isLeaf(next) && isNear(open[first]);
    if (!isLeaf(next)) {
      const Node& node = nodes_[indexOf(next)];
      const Lanes distances = bound(node.boxes);
      if (two) {
        const Node& second = nodes_[indexOf(open[first++])];
        const Lanes of_second = bound(second.boxes);
        first -= openNear(of_second <= limit, of_second, second.children, open.data() + first);
      }
      first -= openNear(distances <= limit, distances, node.children, open.data() + first);
      continue;
    }
    const Leaf* leaf = &leaves_[indexOf(next)];
    Lanes distances = bound(*leaf);
    const Open after = two ? open[first++] : 0;
    const Leaf* const second = two ? &leaves_[indexOf(after)] : nullptr;
    const Lanes of_second = two ? bound(*second) : Lanes{};
    while (true) {
      for (unsigned near = signBits(distances <= limit) & leaf->used; near != 0; near &= near - 1) {
        const auto k = static_cast<std::size_t>(std::countr_zero(near));
        if (distances[k] <= limit) limit = roundedUp(visit(leaf->triangles[k]));
      }
      if (!two || leaf == second || !isNear(after)) break;
      leaf = second;
      distances = of_second;
    }
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
