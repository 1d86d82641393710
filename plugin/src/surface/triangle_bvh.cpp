#include "surface/triangle_bvh.hpp"

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

/// Largest coordinate: what rounding follows.
float sizeOf(const Surface& surface) {
  float size = 0;
  for (const auto& vertex : surface.vertices) {
    for (const float x : vertex) size = std::max(size, std::fabs(x));
  }
  return size;
}

float middle(const Surface& surface, std::uint32_t triangle, int axis) {
  float sum = 0;
  for (const std::uint32_t v : surface.triangles[triangle]) sum += surface.vertices[v][axis];
  return sum;
}

}  // namespace

TriangleBvh::TriangleBvh(const Surface& surface) : triangles_(surface.triangles.size()) {
  std::iota(triangles_.begin(), triangles_.end(), std::uint32_t(0));
  if (triangles_.empty()) return;
  build(surface, 0, triangles_.size());
  nodes_.shrink_to_fit();
  const float padding = kPadding * sizeOf(surface);
  for (Node& node : nodes_) {
    for (Lanes& axis : node.boxes.min) axis -= padding;
    for (Lanes& axis : node.boxes.max) axis += padding;
  }
}

/// Appends the node of triangles [first, end) and all below it.
std::uint32_t TriangleBvh::build(const Surface& surface, std::size_t first, std::size_t end) {
  const std::size_t index = nodes_.size();
  nodes_.emplace_back();
  const std::size_t half = halve(surface, first, end);
  const std::array<std::size_t, kWidth + 1> cuts{first, halve(surface, first, half), half,
                                                 halve(surface, half, end), end};
  for (std::size_t k = 0; k < kWidth; ++k) {
    enclose(surface, cuts[k], cuts[k + 1], k, nodes_[index].boxes);
    const std::size_t count = cuts[k + 1] - cuts[k];
    const Child child = count > kTrianglesPerLeaf
                            ? Child{build(surface, cuts[k], cuts[k + 1]), kInner}
                            : Child{static_cast<std::uint32_t>(cuts[k]), static_cast<std::uint32_t>(count)};
    nodes_[index].children[k] = child;
  }
  return static_cast<std::uint32_t>(index);
}

/// Sorts triangles [first, end) into two halves, across the axis along which they are spread most.
std::size_t TriangleBvh::halve(const Surface& surface, std::size_t first, std::size_t end) {
  int axis = 0;
  float widest = 0;
  for (int k = 0; k < 3; ++k) {
    float least = kFar, most = -kFar;
    for (std::size_t i = first; i < end; ++i) {
      least = std::min(least, middle(surface, triangles_[i], k));
      most = std::max(most, middle(surface, triangles_[i], k));
    }
    if (most - least > widest) {
      widest = most - least;
      axis = k;
    }
  }
  const auto at = [&](std::size_t i) { return triangles_.begin() + static_cast<std::ptrdiff_t>(i); };
  const std::size_t half = first + (end - first) / 2;
  std::nth_element(at(first), at(half), at(end), [&](std::uint32_t a, std::uint32_t b) {
    const float of_a = middle(surface, a, axis), of_b = middle(surface, b, axis);
    return of_a != of_b ? of_a < of_b : a < b;
  });
  return half;
}

/// The box of triangles [first, end); of none it is infinitely far from everything.
void TriangleBvh::enclose(const Surface& surface, std::size_t first, std::size_t end, std::size_t child,
                          Boxes& boxes) const {
  for (std::size_t k = 0; k < 3; ++k) {
    float least = kFar, most = -kFar;
    for (std::size_t i = first; i < end; ++i) {
      for (const std::uint32_t v : surface.triangles[triangles_[i]]) {
        least = std::min(least, surface.vertices[v][k]);
        most = std::max(most, surface.vertices[v][k]);
      }
    }
    boxes.min[k][child] = least;
    boxes.max[k][child] = most;
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
