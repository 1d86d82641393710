#include "mesh/mesh_cuts.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "common/bounds.hpp"
#include "mesh/mesh_clean.hpp"

namespace innersphere {
namespace {

using Corners = std::array<std::uint32_t, 3>;

// Triangles this near touch, in diagonals: more than the rounding of distances.
constexpr double kTouch = 1e-10;

bool uses(const Corners& t, std::uint32_t v) {
  return v == t[0] || v == t[1] || v == t[2];
}

// Sign of the volume of a, b, c and the origin; 0 where rounding could decide it.
int orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, double tolerance) {
  const double volume = dot(a, cross(b, c));
  return volume > tolerance ? 1 : volume < -tolerance ? -1 : 0;
}

bool edgePasses(const Vec3d& from, const Vec3d& to, const std::array<Vec3d, 3>& triangle) {
  const Vec3d edge = to - from;
  const Vec3d a = triangle[0] - from, b = triangle[1] - from, c = triangle[2] - from;
  const double size = std::max({norm(edge), norm(a), norm(b), norm(c)});
  const double tolerance = 1e-14 * size * size * size;
  const int before = orientation(a, b, c, tolerance);
  if (before == 0 || orientation(a - edge, b - edge, c - edge, tolerance) != -before) return false;
  const int side = orientation(edge, a, b, tolerance);
  return side != 0 && orientation(edge, b, c, tolerance) == side &&
         orientation(edge, c, a, tolerance) == side;
}

bool hasEdgeThrough(const Mesh& mesh, const Corners& s, const Corners& t) {
  const std::array<Vec3d, 3> target{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t i = s[k], j = s[(k + 1) % 3];
    if (!uses(t, i) && !uses(t, j) && edgePasses(mesh.vertices[i], mesh.vertices[j], target)) return true;
  }
  return false;
}

/// Whether s is on one side of the plane of t, or of one that stands on it along a side, but for the corners
/// of t in that plane.
bool isAside(const Mesh& mesh, const Corners& s, const Corners& t, double tolerance) {
  const auto at = [&](int k) { return mesh.vertices[t[k % 3]]; };
  const Vec3d normal = cross(at(1) - at(0), at(2) - at(0));
  const double least = tolerance * norm(normal);
  int above = 0, below = 0, common = 0;
  for (const std::uint32_t v : s) {
    const double height = dot(normal, mesh.vertices[v] - at(0));
    if (uses(t, v)) {
      ++common;
    } else if (std::abs(height) > least) {
      ++(height > 0 ? above : below);
    }
  }
  if (common < 3 && common + std::max(above, below) == 3) return true;
  for (int k = 0; k < 3; ++k) {
    const Vec3d outwards = cross(at(k + 1) - at(k), normal);
    const double nearest = tolerance * norm(outwards);
    const auto isOutside = [&](std::uint32_t v) {
      return v == t[k] || v == t[(k + 1) % 3] || dot(outwards, mesh.vertices[v] - at(k)) > nearest;
    };
    if (std::all_of(s.begin(), s.end(), isOutside)) return true;
  }
  return false;
}

/// Finds the boxes that meet, by a tree of them.
class MeetingBoxes {
 public:
  explicit MeetingBoxes(const std::vector<Bounds>& boxes) : boxes_(boxes), order_(boxes.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    build(0, static_cast<std::uint32_t>(order_.size()));
    for (const std::uint32_t i : order_) sorted_.push_back(boxes[i]);
  }

  /// Calls visit(i, j) once for each pair.
  template <class Visit>
  void forPairs(const Visit& visit) const {
    forPairsIn(0, visit);
  }

 private:
  static constexpr std::uint32_t kLeaf = 4;

  /// One child follows it. A leaf has no other one.
  struct Node {
    Bounds box = emptyBounds();
    std::uint32_t begin, end, other = 0;
  };

  void build(std::uint32_t begin, std::uint32_t end) {
    const std::size_t self = nodes_.size();
    Node node{.begin = begin, .end = end};
    Bounds middles = emptyBounds();
    for (std::uint32_t i = begin; i < end; ++i) {
      const Bounds& box = boxes_[order_[i]];
      extend(node.box, box.min);
      extend(node.box, box.max);
      extend(middles, centre(box));
    }
    nodes_.push_back(node);
    if (end - begin <= kLeaf) return;
    const Vec3d size = middles.max - middles.min;
    const int axis = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
    const std::uint32_t half = begin + (end - begin) / 2;
    const auto middle = [&](std::uint32_t i) { return boxes_[i].min[axis] + boxes_[i].max[axis]; };
    std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end,
                     [&](std::uint32_t i, std::uint32_t j) { return middle(i) < middle(j); });
    build(begin, half);
    nodes_[self].other = static_cast<std::uint32_t>(nodes_.size());
    build(half, end);
  }

  template <class Visit>
  void forPairsIn(std::uint32_t n, const Visit& visit) const {
    const Node& node = nodes_[n];
    if (node.other == 0) return forPairsOf(node, node, visit);
    forPairsIn(n + 1, visit);
    forPairsIn(node.other, visit);
    forPairsBetween(n + 1, node.other, visit);
  }

  template <class Visit>
  void forPairsBetween(std::uint32_t m, std::uint32_t n, const Visit& visit) const {
    const Node &a = nodes_[m], &b = nodes_[n];
    if (!meet(a.box, b.box)) return;
    if (a.other == 0 && b.other == 0) return forPairsOf(a, b, visit);
    if (a.end - a.begin >= b.end - b.begin) {
      forPairsBetween(m + 1, n, visit);
      forPairsBetween(a.other, n, visit);
    } else {
      forPairsBetween(m, n + 1, visit);
      forPairsBetween(m, b.other, visit);
    }
  }

  template <class Visit>
  void forPairsOf(const Node& a, const Node& b, const Visit& visit) const {
    for (std::uint32_t i = a.begin; i < a.end; ++i) {
      for (std::uint32_t j = &a == &b ? i + 1 : b.begin; j < b.end; ++j) {
        if (meet(sorted_[i], sorted_[j])) visit(order_[i], order_[j]);
      }
    }
  }

  const std::vector<Bounds>& boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Bounds> sorted_;
  std::vector<Node> nodes_;
};

/// The triangles' boxes, larger by how near triangles touch.
struct Boxes {
  std::vector<Bounds> of_triangles;
  Bounds all = emptyBounds();
  double tolerance;  ///< [m]
};

Boxes boxesOf(const Mesh& mesh) {
  Boxes boxes;
  for (const Corners& t : mesh.triangles) {
    Bounds box = emptyBounds();
    for (std::uint32_t v : t) extend(box, mesh.vertices[v]);
    extend(boxes.all, box.min);
    extend(boxes.all, box.max);
    boxes.of_triangles.push_back(box);
  }
  boxes.tolerance = kTouch * (diagonal(boxes.all) + norm(boxes.all.min));
  for (Bounds& box : boxes.of_triangles) {
    for (double& x : box.max) x += boxes.tolerance;
  }
  return boxes;
}

}  // namespace

Cuts findCuts(const Mesh& mesh) {
  const Boxes boxes = boxesOf(mesh);
  // The first pair has the triangle that begins first along the longest axis.
  const Vec3d size = boxes.all.max - boxes.all.min;
  const int axis = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
  const auto begins = [&](std::uint32_t i) { return std::pair(boxes.of_triangles[i].min[axis], i); };
  auto first = std::pair(std::numeric_limits<double>::infinity(), 0u);
  Cuts cuts;
  cuts.touched.resize(mesh.triangles.size());
  MeetingBoxes(boxes.of_triangles).forPairs([&](std::uint32_t i, std::uint32_t j) {
    const Corners &s = mesh.triangles[i], &t = mesh.triangles[j];
    if (isAside(mesh, s, t, boxes.tolerance) || isAside(mesh, t, s, boxes.tolerance)) return;
    cuts.touched[i] = cuts.touched[j] = true;
    if (!hasEdgeThrough(mesh, s, t) && !hasEdgeThrough(mesh, t, s)) return;
    ++cuts.pairs;
    first = std::min({first, begins(i), begins(j)});
  });
  if (cuts.pairs > 0) cuts.at = mesh.vertices[mesh.triangles[first.second][0]];
  return cuts;
}

bool cutEachOther(const Mesh& a, const Mesh& b) {
  Mesh both = a;
  append(both, b);
  bool cut = false;
  MeetingBoxes(boxesOf(both).of_triangles).forPairs([&](std::uint32_t i, std::uint32_t j) {
    if (cut || (i < a.triangles.size()) == (j < a.triangles.size())) return;
    const Corners &s = both.triangles[i], &t = both.triangles[j];
    cut = hasEdgeThrough(both, s, t) || hasEdgeThrough(both, t, s);
  });
  return cut;
}

}  // namespace innersphere
