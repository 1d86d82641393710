#include "surface/surface_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "innersphere/error.hpp"
#include "surface/box.hpp"

namespace innersphere {

namespace {

/// Boxes are no longer than this, in sides of a square of a triangle's mean area: long triangles are in
/// several, for one box around them is mostly empty. Nor are they shorter than this part of what triangles
/// are long on average: where all are needles, that bounds the number of boxes.
constexpr double kLongest = 3, kShortest = 1.0 / 8;

/// Coarse cells from the middle of a surface to its farthest side. That is before the end of the grid, and
/// the sum of two numbers up to that is less than 2^15.
constexpr float kCoarseHalf = 16000;
static_assert(kCoarseHalf < SurfaceTree::CoarseGrid::kEnd && 2 * SurfaceTree::CoarseGrid::kEnd < 0x1p15F);
/// More cells than this are none in single precision.
constexpr double kMostCells = 1e30;

/// Of a part of a triangle.
constexpr std::size_t kMostCorners = 4;

double areaOf(const Bounds& box) {
  const Vec3d d = box.max - box.min;
  return d.x * d.y + d.y * d.z + d.z * d.x;
}

}  // namespace

/// Sorts the triangles, so that those of each node follow each other.
class SurfaceTree::Builder {
 public:
  explicit Builder(SurfaceTree& tree);
  /// Appends the node of triangles [first, end) and all below it.
  std::uint32_t build(std::uint32_t first, std::uint32_t end);
  Bounds boundsOf(std::uint32_t first, std::uint32_t end) const;
  std::uint32_t size() const { return static_cast<std::uint32_t>(parts_.size()); }

 private:
  using Order = std::vector<std::uint32_t>;
  struct Part {
    std::uint32_t triangle;
    std::uint32_t corners;  ///< where they are
    Bounds box;
    double middle(int axis) const { return box.min[axis] + box.max[axis]; }
  };
  void addCorners(Node& node, std::uint32_t first, std::uint32_t end);
  std::uint32_t halve(std::uint32_t first, std::uint32_t end);
  void addParts(std::uint32_t triangle, const std::vector<Vec3d>& polygon, double most);

  SurfaceTree& tree_;
  struct PartCorners {
    Vec3d at[kMostCorners];
    std::uint8_t count;
  };
  std::vector<Part> parts_;
  std::vector<PartCorners> corners_;
  Order order_;         ///< of the parts in the tree
  Order by_middle_[3];  ///< of the parts of each node along an axis
  Order rest_;
  std::vector<bool> is_second_;  ///< whether each part is in the second half
  std::vector<Bounds> boxes_;    ///< of what fills whole nodes
  std::vector<double> costs_;
};

SurfaceTree::Builder::Builder(SurfaceTree& tree) : tree_(tree) {
  const auto at = [&](std::uint32_t v) {
    return Vec3d{tree.vertices_[v][0], tree.vertices_[v][1], tree.vertices_[v][2]};
  };
  double area = 0, length = 0;
  for (const Triangle& t : tree.triangles_) {
    const Vec3d u = at(t[1]) - at(t[0]), v = at(t[2]) - at(t[0]);
    area += norm(cross(u, v)) / 2;
    length += std::max(largest(u), largest(v));
  }
  const auto count = static_cast<double>(tree.triangles_.size());
  const double most = std::max(kLongest * std::sqrt(area / count), kShortest * length / count);
  for (std::uint32_t i = 0; i < tree.triangles_.size(); ++i) {
    const Triangle& t = tree.triangles_[i];
    const Vec3d corners[3] = {at(t[0]), at(t[1]), at(t[2])};
    addParts(i, {corners, corners + 3}, most);
  }
  order_.resize(parts_.size());
  std::iota(order_.begin(), order_.end(), 0U);
  is_second_.resize(parts_.size());
  for (int axis = 0; axis < 3; ++axis) {
    by_middle_[axis] = order_;
    std::stable_sort(by_middle_[axis].begin(), by_middle_[axis].end(), [&](std::uint32_t a, std::uint32_t b) {
      return parts_[a].middle(axis) < parts_[b].middle(axis);
    });
  }
}

/// Adds a part of a triangle, or both halves of it.
void SurfaceTree::Builder::addParts(std::uint32_t triangle, const std::vector<Vec3d>& polygon, double most) {
  Bounds box = nothing();
  for (const Vec3d& corner : polygon) include({corner, corner}, box);
  const Vec3d size = box.max - box.min;
  const int axis = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
  if (size[axis] <= most) {
    for (std::size_t i = 1; i + 1 < polygon.size(); i += kMostCorners - 2) {
      Part& part =
          parts_.emplace_back(Part{triangle, static_cast<std::uint32_t>(corners_.size()), nothing()});
      PartCorners& corners = corners_.emplace_back(PartCorners{{polygon[0]}, 1});
      for (std::size_t k = i; k < std::min(i + kMostCorners - 1, polygon.size()); ++k)
        corners.at[corners.count++] = polygon[k];
      for (int c = 0; c < corners.count; ++c) include({corners.at[c], corners.at[c]}, part.box);
    }
    return;
  }
  const double middle = box.min[axis] + size[axis] / 2;
  for (const double side : {-1, 1}) {
    std::vector<Vec3d> half;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3d &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
      const double hp = side * (p[axis] - middle), hq = side * (q[axis] - middle);
      if (hp >= 0) half.push_back(p);
      if ((hp < 0) != (hq < 0)) half.push_back(p + hp / (hp - hq) * (q - p));
    }
    addParts(triangle, half, most);
  }
}

std::uint32_t SurfaceTree::Builder::build(std::uint32_t first, std::uint32_t end) {
  std::vector<Node>& nodes = tree_.nodes_;
  const auto index = static_cast<std::uint32_t>(nodes.size());
  nodes.emplace_back().are_triangles = end - first <= kWidth;
  Bounds boxes[kWidth];
  std::array<std::uint32_t, kWidth + 1> cuts;
  if (end - first <= kWidth) {
    for (std::uint32_t k = 0; k <= kWidth; ++k) cuts[k] = std::min(first + k, end);
  } else {
    const std::uint32_t half = halve(first, end);
    cuts = {first, halve(first, half), half, halve(half, end), end};
  }
  for (std::uint32_t k = 0; k < kWidth; ++k) {
    if (cuts[k] == cuts[k + 1]) continue;
    std::uint32_t child = parts_[order_[cuts[k]]].triangle;
    if (!nodes[index].are_triangles) {
      child = build(cuts[k], cuts[k + 1]);
    }
    boxes[nodes[index].count] = boundsOf(cuts[k], cuts[k + 1]);
    nodes[index].children[nodes[index].count++] = child;
  }
  if (nodes[index].are_triangles) addCorners(nodes[index], first, end);
  tree_.addBoxes(nodes[index], boxes);
  return index;
}

void SurfaceTree::Builder::addCorners(Node& node, std::uint32_t first, std::uint32_t end) {
  for (std::uint32_t i = first; i < end; ++i)
    node.corners = std::max(node.corners, corners_[parts_[order_[i]].corners].count);
  for (std::uint32_t i = first; i < end; ++i) {
    const PartCorners& corners = corners_[parts_[order_[i]].corners];
    for (int c = 0; c < node.corners; ++c) {
      const Vec3d& corner = corners.at[std::min(c, corners.count - 1)];
      for (int axis = 0; axis < 3; ++axis)
        node.extent[3 * c + axis][i - first] = static_cast<float>(corner[axis]);
    }
  }
}

/// Sorts triangles [first, end) into two parts, so that the areas of their boxes, times the numbers of
/// triangles, are least (the surface area heuristic). The first one fills whole nodes. Returns where the
/// second one begins: at `end` if one node is enough.
std::uint32_t SurfaceTree::Builder::halve(std::uint32_t first, std::uint32_t end) {
  if (end - first <= kWidth) return end;
  const auto in = [&](Order& order) { return std::span(order).subspan(first, end - first); };
  const std::uint32_t full = (end - first + kWidth - 1) / kWidth;
  // Neither part has less than this: the tree cannot become a list.
  const std::uint32_t least_full = std::max(1U, full / 8);
  double least = std::numeric_limits<double>::infinity();
  std::uint32_t cut = 0;
  int across = 0;
  for (int axis = 0; axis < 3; ++axis) {
    boxes_.assign(full, nothing());
    for (std::uint32_t i = first; i < end; ++i)
      include(parts_[by_middle_[axis][i]].box, boxes_[(i - first) / kWidth]);
    costs_.assign(full, 0);
    Bounds low = nothing(), high = nothing();
    for (std::uint32_t k = 0; k + 1 < full; ++k) {
      include(boxes_[k], low);
      costs_[k + 1] += areaOf(low) * (k + 1);
    }
    for (std::uint32_t k = full; k-- > 1;) {
      include(boxes_[k], high);
      costs_[k] += areaOf(high) * (full - k);
    }
    const auto best = std::min_element(costs_.begin() + least_full, costs_.end() - (least_full - 1));
    if (!(*best < least)) continue;
    least = *best;
    cut = first + static_cast<std::uint32_t>(best - costs_.begin()) * kWidth;
    across = axis;
  }
  std::ranges::copy(in(by_middle_[across]), in(order_).begin());
  for (std::uint32_t i = first; i < end; ++i) is_second_[order_[i]] = i >= cut;
  for (Order& order : by_middle_) {
    rest_.clear();
    auto to = in(order).begin();
    for (const std::uint32_t part : in(order)) {
      if (is_second_[part]) {
        rest_.push_back(part);
      } else {
        *to++ = part;
      }
    }
    std::ranges::copy(rest_, to);
  }
  return cut;
}

Bounds SurfaceTree::Builder::boundsOf(std::uint32_t first, std::uint32_t end) const {
  Bounds box = nothing();
  for (std::uint32_t i = first; i < end; ++i) include(parts_[order_[i]].box, box);
  return box;
}

SurfaceTree::Twins SurfaceTree::findTwins(const Surface& surface) {
  struct Edge {
    std::uint32_t low, high, backward, number;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * surface.triangles.size());
  Twins twins(surface.triangles.size());
  for (std::uint32_t i = 0; i < surface.triangles.size(); ++i) {
    const auto& t = surface.triangles[i];
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      twins[i][k] = 4 * i + k;
      if (low != high) edges.push_back({low, high, low == t[k] ? 0U : 1U, 4 * i + k});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.backward, a.number) < std::tie(b.low, b.high, b.backward, b.number);
  });
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i, forward = 0;
    for (; end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high; ++end)
      forward += 1 - edges[end].backward;
    if (2 * forward != end - i) return {};
    for (; i + forward < end; ++i) {
      const std::uint32_t there = edges[i].number, back = edges[i + forward].number;
      twins[there / 4][there % 4] = back;
      twins[back / 4][back % 4] = there;
    }
    i = end;
  }
  return twins;
}

SurfaceTree::SurfaceTree(const Surface& surface) : SurfaceTree(surface, findTwins(surface)) {}

std::optional<SurfaceTree> SurfaceTree::ifClosed(const Surface& surface) {
  Twins twins = findTwins(surface);
  if (twins.empty()) return std::nullopt;
  return SurfaceTree(surface, std::move(twins));
}

SurfaceTree::SurfaceTree(const Surface& surface, Twins twins) : twins_(std::move(twins)) {
  if (surface.triangles.empty()) {
    throw Error(ErrorCode::empty_input,
                "the packing carries no triangles; pack the mesh again, or use another estimator");
  }
  if (twins_.empty()) {
    throw Error(ErrorCode::not_a_solid,
                "the triangles that the packing carries are not closed; use another estimator");
  }
  vertices_.reserve(surface.vertices.size());
  for (const auto& v : surface.vertices) vertices_.push_back(Lanes{v[0], v[1], v[2]});
  triangles_ = surface.triangles;
  Builder builder(*this);
  const std::uint32_t count = builder.size();
  bounds_ = builder.boundsOf(0, count);
  grid_.middle = 0.5 * (bounds_.min + bounds_.max);
  grid_.per = std::min(kCoarseHalf / largest(bounds_.max - grid_.middle), kMostCells);
  builder.build(0, count);
  sortAsInTree();
  findParts();
}

void SurfaceTree::sortAsInTree() {
  constexpr std::uint32_t kNone = ~0U;
  std::vector<std::uint32_t> of_triangle(triangles_.size(), kNone), of_vertex(vertices_.size(), kNone);
  std::vector<Triangle> triangles;
  std::vector<Lanes> vertices;
  Twins twins;
  for (Node& node : nodes_) {
    for (std::uint32_t i = 0; node.are_triangles && i < node.count; ++i) {
      std::uint32_t& child = node.children[i];
      std::uint32_t& number = of_triangle[child];
      if (number == kNone) {
        number = static_cast<std::uint32_t>(triangles.size());
        twins.push_back(twins_[child]);
        for (std::uint32_t& v : triangles.emplace_back(triangles_[child])) {
          if (of_vertex[v] == kNone) {
            of_vertex[v] = static_cast<std::uint32_t>(vertices.size());
            vertices.push_back(vertices_[v]);
          }
          v = of_vertex[v];
        }
      }
      child = number;
    }
  }
  for (auto& of_one : twins) {
    for (std::uint32_t& twin : of_one) twin = 4 * of_triangle[twin / 4] + twin % 4;
  }
  triangles_ = std::move(triangles);
  vertices_ = std::move(vertices);
  twins_ = std::move(twins);
}

void SurfaceTree::addBoxes(Node& node, const Bounds* boxes) const {
  const auto per = static_cast<float>(grid_.per);
  const auto slack = static_cast<float>(kSingleRounding * grid_.per * largest(bounds_));
  Lanes centre[3]{}, half[3]{};
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < node.count; ++i) {
      const auto low = static_cast<float>(boxes[i].min[axis]), high = static_cast<float>(boxes[i].max[axis]);
      centre[axis][i] = low + (high - low) / 2;
      half[axis][i] = std::max(high - centre[axis][i], centre[axis][i] - low);
    }
    const Lanes at = per * (centre[axis] - static_cast<float>(grid_.middle[axis])),
                size = per * half[axis] + slack;
    node.sides[axis] = grid_.sides(size + at, size - at);
  }
  for (std::uint32_t i = node.count; i < kWidth; ++i) node.sides[0][i] = CoarseGrid::kNoBox;
  if (node.are_triangles) return;
  std::copy(centre, centre + 3, node.extent);
  std::copy(half, half + 3, node.extent + 3);
}

void SurfaceTree::findParts() {
  constexpr std::uint32_t kNone = ~0U;
  parts_.assign(triangles_.size(), kNone);
  std::vector<std::uint32_t> open;
  for (std::uint32_t first = 0; first < triangles_.size(); ++first) {
    if (parts_[first] != kNone) continue;
    const std::uint32_t part = partCount();
    triangle_of_part_.push_back(first);
    parts_[first] = part;
    open.push_back(first);
    while (!open.empty()) {
      const std::uint32_t from = open.back();
      open.pop_back();
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t to = twins_[from][k] / 4;
        if (parts_[to] == kNone) parts_[to] = part, open.push_back(to);
      }
    }
  }
  if (partCount() == 1) parts_ = {};
}

}  // namespace innersphere
