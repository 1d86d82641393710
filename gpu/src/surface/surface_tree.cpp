#include "surface/surface_tree.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "innersphere/error.hpp"

namespace innersphere {

namespace {

/// Returns whether each edge is run along as often in one direction as in the other.
bool isClosed(const Surface& surface) {
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

}  // namespace

SurfaceTree::SurfaceTree(const Surface& surface) {
  if (surface.triangles.empty()) {
    throw Error(ErrorCode::empty_input,
                "the packing carries no triangles; pack the mesh again, or use another estimator");
  }
  if (!isClosed(surface)) {
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
  build(0, static_cast<std::uint32_t>(triangles_.size()));
}

/// Appends the node of triangles [first, end) and all below it.
void SurfaceTree::build(std::uint32_t first, std::uint32_t end) {
  Vec3f low = triangles_[first][0], high = low;
  for (std::uint32_t i = first; i < end; ++i) {
    for (const Vec3f& v : triangles_[i]) {
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], v[k]);
        high[k] = std::max(high[k], v[k]);
      }
    }
  }
  Node node;
  for (int k = 0; k < 3; ++k) {
    node.centre[k] = (double{low[k]} + high[k]) / 2;
    node.half[k] = (double{high[k]} - low[k]) / 2;
  }
  const bool leaf = end - first <= kLeafTriangles;
  node.first = first;
  node.count = leaf ? end - first : 0;
  const std::size_t index = nodes_.size();
  nodes_.push_back(node);
  if (leaf) return;

  const int axis = static_cast<int>(std::max_element(node.half.begin(), node.half.end()) - node.half.begin());
  const auto at = [&](std::uint32_t i) { return triangles_.begin() + static_cast<std::ptrdiff_t>(i); };
  const auto middle = [&](const Triangle& t) { return t[0][axis] + t[1][axis] + t[2][axis]; };
  // Whole leaves go to the left, so that they are full.
  const std::uint32_t leaves = (end - first + kLeafTriangles - 1) / kLeafTriangles;
  const std::uint32_t half = first + (leaves + 1) / 2 * kLeafTriangles;
  std::stable_sort(at(first), at(end),
                   [&](const Triangle& a, const Triangle& b) { return middle(a) < middle(b); });
  build(first, half);
  nodes_[index].first = static_cast<std::uint32_t>(nodes_.size());
  build(half, end);
}

}  // namespace innersphere
