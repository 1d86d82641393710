#include "surface/surface_tree.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "innersphere/error.hpp"
#include "surface/box.hpp"

namespace innersphere {

bool isClosedSurface(const Surface& surface) {
  struct HalfEdge {
    std::uint32_t low, high;
    int direction;
  };
  std::vector<HalfEdge> edges;
  edges.reserve(3 * surface.triangles.size());
  for (const auto& t : surface.triangles) {
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      edges.push_back({low, high, low == t[k] ? 1 : -1});
    }
  }
  const auto key = [](const HalfEdge& e) { return std::tie(e.low, e.high); };
  std::sort(edges.begin(), edges.end(),
            [&](const HalfEdge& a, const HalfEdge& b) { return key(a) < key(b); });
  int surplus = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (edges[i].low != edges[i].high) surplus += edges[i].direction;
    const bool last = i + 1 == edges.size() || key(edges[i]) != key(edges[i + 1]);
    if (last && surplus != 0) return false;
  }
  return true;
}

SurfaceTree::SurfaceTree(const Surface& surface) {
  if (surface.triangles.empty()) {
    throw Error(ErrorCode::empty_input,
                "the packing carries no triangles; pack the mesh again, or use another estimator");
  }
  if (!isClosedSurface(surface)) {
    throw Error(ErrorCode::not_a_solid,
                "the triangles that the packing carries are not closed; use another estimator");
  }
  triangles_.reserve(surface.triangles.size());
  for (const auto& t : surface.triangles) {
    Triangle& triangle = triangles_.emplace_back();
    for (int k = 0; k < 3; ++k) {
      const auto& v = surface.vertices[t[k]];
      triangle[k] = {v[0], v[1], v[2]};
    }
  }
  const auto count = static_cast<std::uint32_t>(triangles_.size());
  bounds_ = boundsOf(0, count);
  build(0, count);
}

/// Appends the node of triangles [first, end) and all below it.
std::uint32_t SurfaceTree::build(std::uint32_t first, std::uint32_t end) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  const std::uint32_t half = halve(first, end);
  const std::array<std::uint32_t, kWidth + 1> cuts{first, halve(first, half), half, halve(half, end), end};
  for (std::size_t k = 0; k < kWidth; ++k) {
    constexpr double kNone = -1e300;
    const bool none = cuts[k] == cuts[k + 1];
    const Bounds box = none ? Bounds{} : boundsOf(cuts[k], cuts[k + 1]);
    for (int axis = 0; axis < 3; ++axis) {
      nodes_[index].centre[axis][k] = (box.max[axis] + box.min[axis]) / 2;
      nodes_[index].half[axis][k] = none ? kNone : (box.max[axis] - box.min[axis]) / 2;
    }
    const std::uint32_t count = cuts[k + 1] - cuts[k];
    const Child child =
        count > kLeafTriangles ? Child{build(cuts[k], cuts[k + 1]), 0} : Child{cuts[k], count};
    nodes_[index].children[k] = child;
  }
  return index;
}

/// Sorts triangles [first, end) into two halves along the longest side of their box, with whole leaves in the
/// first half. Returns where the second one begins: at `end` if one leaf is enough.
std::uint32_t SurfaceTree::halve(std::uint32_t first, std::uint32_t end) {
  if (end - first <= kLeafTriangles) return end;
  const Bounds box = boundsOf(first, end);
  const Vec3d size = box.max - box.min;
  const auto axis = static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
  const auto at = [&](std::uint32_t i) { return triangles_.begin() + static_cast<std::ptrdiff_t>(i); };
  const auto middle = [&](const Triangle& t) { return t[0][axis] + t[1][axis] + t[2][axis]; };
  std::stable_sort(at(first), at(end),
                   [&](const Triangle& a, const Triangle& b) { return middle(a) < middle(b); });
  const std::uint32_t leaves = (end - first + kLeafTriangles - 1) / kLeafTriangles;
  return first + (leaves + 1) / 2 * kLeafTriangles;
}

Bounds SurfaceTree::boundsOf(std::uint32_t first, std::uint32_t end) const {
  Bounds box = nothing();
  for (std::uint32_t i = first; i < end; ++i) {
    for (const Vec3f& v : triangles_[i]) {
      const Vec3d corner{v.x, v.y, v.z};
      include({corner, corner}, box);
    }
  }
  return box;
}

}  // namespace innersphere
