#include "surface/triangle_bvh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Boxes are larger than their triangles by this fraction of the surface's size, so that rounding does not
/// let a ray miss the flat ones that it runs along.
constexpr float kPadding = 4e-6F;
/// In heights of a triangle: how far beyond its edges a line is still looked at. SmoothNormals lets it meet
/// the triangle up to half as far.
constexpr float kLookedBeyond = 2e-4F;

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

Vec3d unit(const Vec3d& v) {
  const double length = norm(v);
  return length > 0 ? (1 / length) * v : Vec3d{};
}

void setPlane(const Vec3d& normal, const Vec3d& place, std::size_t lane, TriangleBvh::Planes& planes) {
  for (std::size_t k = 0; k < 3; ++k) planes.normal[k][lane] = static_cast<float>(normal[k]);
  planes.offset[lane] = static_cast<float>(dot(normal, place));
}

void setTriangle(const Surface& surface, std::uint32_t triangle, std::size_t lane, TriangleBvh::Leaf& leaf) {
  Vec3d corners[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& vertex = surface.vertices[surface.triangles[triangle][k]];
    corners[k] = {vertex[0], vertex[1], vertex[2]};
  }
  const Vec3d face = unit(cross(corners[1] - corners[0], corners[2] - corners[0]));
  setPlane(face, corners[0], lane, leaf.faces);
  double highest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d inwards = unit(cross(face, corners[(k + 1) % 3] - corners[k]));
    setPlane(inwards, corners[k], lane, leaf.edges[k]);
    highest = std::max(highest, dot(inwards, corners[(k + 2) % 3] - corners[k]));
  }
  leaf.lowest[lane] = -kLookedBeyond * static_cast<float>(highest);
  leaf.triangles[lane] = triangle;
}

}  // namespace

TriangleBvh::TriangleBvh(const Surface& surface)
    : rounding_(kPadding * sizeOf(surface)), triangles_(surface.triangles.size()) {
  std::iota(triangles_.begin(), triangles_.end(), std::uint32_t(0));
  if (triangles_.empty()) return;
  build(surface, 0, triangles_.size());
  nodes_.shrink_to_fit();
  leaves_.shrink_to_fit();
  triangles_ = {};
  for (Node& node : nodes_) {
    for (Lanes& axis : node.boxes.min) axis -= rounding_;
    for (Lanes& axis : node.boxes.max) axis += rounding_;
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
    const bool is_leaf = cuts[k + 1] - cuts[k] <= kWidth;
    const Child child =
        is_leaf ? kLeaf | appendLeaf(surface, cuts[k], cuts[k + 1]) : build(surface, cuts[k], cuts[k + 1]);
    nodes_[index].children[k] = static_cast<std::int32_t>(child | static_cast<Child>(k) << kNumberShift);
  }
  return static_cast<std::uint32_t>(index);
}

std::uint32_t TriangleBvh::appendLeaf(const Surface& surface, std::size_t first, std::size_t end) {
  Leaf& leaf = leaves_.emplace_back();
  leaf.used = (1u << (end - first)) - 1;
  for (std::size_t i = first; i < end; ++i) setTriangle(surface, triangles_[i], i - first, leaf);
  return static_cast<std::uint32_t>(leaves_.size() - 1);
}

/// Sorts triangles [first, end) into two halves, across the axis along which they are spread most. The first
/// one fills whole leaves.
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
  const std::size_t full = ((end - first) / 2 + kWidth - 1) / kWidth * kWidth;
  const std::size_t half = std::min(first + full, end);
  if (half == end) return end;
  std::nth_element(at(first), at(half), at(end), [&](std::uint32_t a, std::uint32_t b) {
    const float of_a = middle(surface, a, axis), of_b = middle(surface, b, axis);
    return of_a != of_b ? of_a < of_b : a < b;
  });
  return half;
}

/// The box of triangles [first, end); of none it is infinitely far from everything, and no ray leaves it.
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
    boxes.max[k][child] = first < end ? most : kFar;
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
