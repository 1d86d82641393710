#include "triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

constexpr std::size_t kTrianglesPerLeaf = 2;
/// Boxes are larger than their triangles by this fraction of the surface's size, so that rounding does not
/// let a ray miss the flat ones that it runs along.
constexpr float kPadding = 4e-6F;

void add(const std::array<float, 3>& p, TriangleTree::Box& box) {
  for (int k = 0; k < 3; ++k) {
    box.min[k] = std::min(box.min[k], p[k]);
    box.max[k] = std::max(box.max[k], p[k]);
  }
}

TriangleTree::Box emptyBox() {
  TriangleTree::Box box;
  box.min.fill(std::numeric_limits<float>::infinity());
  box.max.fill(-std::numeric_limits<float>::infinity());
  return box;
}

/// Largest coordinate: what rounding follows.
float sizeOf(const Surface& surface) {
  float size = 0;
  for (const auto& vertex : surface.vertices) {
    for (const float x : vertex) size = std::max(size, std::fabs(x));
  }
  return size;
}

}  // namespace

TriangleTree::TriangleTree(const Surface& surface) : triangles_(surface.triangles.size()) {
  std::iota(triangles_.begin(), triangles_.end(), std::uint32_t(0));
  if (triangles_.empty()) return;
  nodes_.reserve(2 * triangles_.size());
  build(surface, 0, triangles_.size());
  nodes_.shrink_to_fit();
  const float padding = kPadding * sizeOf(surface);
  for (Node& node : nodes_) {
    for (int k = 0; k < 3; ++k) {
      node.box.min[k] -= padding;
      node.box.max[k] += padding;
    }
  }
}

/// Appends the node of triangles [first, end) and all below it.
void TriangleTree::build(const Surface& surface, std::size_t first, std::size_t end) {
  const auto middle = [&](std::uint32_t t, int axis) {
    float sum = 0;
    for (const std::uint32_t v : surface.triangles[t]) sum += surface.vertices[v][axis];
    return sum;
  };
  Box box = emptyBox(), middles = emptyBox();
  for (std::size_t i = first; i < end; ++i) {
    const std::uint32_t t = triangles_[i];
    for (const std::uint32_t v : surface.triangles[t]) add(surface.vertices[v], box);
    add({middle(t, 0), middle(t, 1), middle(t, 2)}, middles);
  }
  const std::size_t node = nodes_.size();
  const std::size_t count = end - first;
  const bool leaf = count <= kTrianglesPerLeaf;
  nodes_.push_back({box, static_cast<std::uint32_t>(first), leaf ? static_cast<std::uint32_t>(count) : 0});
  if (leaf) return;
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (middles.max[k] - middles.min[k] > middles.max[axis] - middles.min[axis]) axis = k;
  }
  const auto at = [&](std::size_t i) { return triangles_.begin() + static_cast<std::ptrdiff_t>(i); };
  const std::size_t half = first + count / 2;
  std::nth_element(at(first), at(half), at(end), [&](std::uint32_t a, std::uint32_t b) {
    const float of_a = middle(a, axis), of_b = middle(b, axis);
    return of_a != of_b ? of_a < of_b : a < b;
  });
  build(surface, first, half);
  nodes_[node].first = static_cast<std::uint32_t>(nodes_.size());
  build(surface, half, end);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
