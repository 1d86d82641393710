#include "mesh/closest_triangle.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

namespace innersphere {
namespace {

// Covers the rounding to float of a query point, of boxes and of heights above planes, all relative to unit
// diagonal: a height has eight roundings of up to sqrt(3), and two heights make a distance.
constexpr double kFloatSlack = 4e-6;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

float roundedUp(double x) {
  return std::nextafter(static_cast<float>(x), kInfinity);
}

/// Begins to load what is looked at soon: of large meshes it is far away in memory. Its end may lie beyond.
inline void fetch(const void* begin, std::size_t size) {
  constexpr std::size_t kLine = 64;
  const auto at = reinterpret_cast<std::uintptr_t>(begin);
  for (std::size_t k = 0; k < size; k += kLine) __builtin_prefetch(reinterpret_cast<const void*>(at + k));
}

Vec3d unit(const Vec3d& v) {
  return (1 / norm(v)) * v;
}

}  // namespace

/// Sorts the triangles and builds the tree.
class ClosestTriangle::Builder {
 public:
  Builder(ClosestTriangle& tree, const Mesh& mesh) : tree_(tree), order_(tree.number_) {
    for (const auto& t : mesh.triangles) {
      Bounds& box = boxes_.emplace_back(emptyBounds());
      for (const std::uint32_t v : t) extend(box, tree.to_unit_ * (mesh.vertices[v] - tree.centre_));
    }
    order_.resize(boxes_.size());
    std::iota(order_.begin(), order_.end(), 0u);
  }

  /// Appends the tree of triangles [first, end) and returns its root: a node, or a leaf.
  std::uint32_t build(std::uint32_t first, std::uint32_t end) {
    if (end - first <= kWidth) return first / kWidth | kLeaf;
    const std::uint32_t half = halve(first, end);
    const std::uint32_t cuts[] = {first, halve(first, half), half, halve(half, end), end};
    Node node;
    for (std::uint32_t k = 0; k < kWidth; ++k) {
      if (cuts[k] == cuts[k + 1]) continue;
      Bounds box = emptyBounds();
      for (std::uint32_t i = cuts[k]; i < cuts[k + 1]; ++i) {
        extend(box, boxes_[order_[i]].min);
        extend(box, boxes_[order_[i]].max);
      }
      for (int axis = 0; axis < 3; ++axis) {
        node.low[axis][node.count] = -roundedUp(-box.min[axis]);
        node.high[axis][node.count] = roundedUp(box.max[axis]);
      }
      node.children[node.count++] = build(cuts[k], cuts[k + 1]);
    }
    tree_.nodes_.push_back(node);
    return static_cast<std::uint32_t>(tree_.nodes_.size() - 1);
  }

 private:
  double middle(std::uint32_t triangle, int axis) const {
    return boxes_[triangle].min[axis] + boxes_[triangle].max[axis];
  }

  /// Sorts the triangles into two halves, across the axis along which they are spread most. The first one
  /// fills whole leaves. Returns where the second one begins: at `end` if one leaf is enough.
  std::uint32_t halve(std::uint32_t first, std::uint32_t end) {
    if (end - first <= kWidth) return end;
    Bounds middles = emptyBounds();
    for (std::uint32_t i = first; i < end; ++i) extend(middles, centre(boxes_[order_[i]]));
    const Vec3d size = middles.max - middles.min;
    const int axis = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
    const std::uint32_t half = first + ((end - first) / 2 + kWidth - 1) / kWidth * kWidth;
    std::nth_element(order_.begin() + first, order_.begin() + half, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                       const double of_a = middle(a, axis), of_b = middle(b, axis);
                       return of_a != of_b ? of_a < of_b : a < b;
                     });
    return half;
  }

  ClosestTriangle& tree_;
  std::vector<std::uint32_t>& order_;
  std::vector<Bounds> boxes_;
};

void ClosestTriangle::Planes::set(std::uint32_t lane, const Vec3d& unit_normal, const Vec3d& place) {
  for (int axis = 0; axis < 3; ++axis) normal[axis][lane] = static_cast<float>(unit_normal[axis]);
  offset[lane] = static_cast<float>(dot(unit_normal, place));
}

ClosestTriangle::ClosestTriangle(const Mesh& mesh) {
  const Bounds box = boundsOf(mesh);
  centre_ = centre(box);
  to_unit_ = 1 / diagonal(box);
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  Builder(*this, mesh).build(0, count);
  triangles_.reserve(count);
  leaves_.resize((count + kWidth - 1) / kWidth);
  for (std::uint32_t i = 0; i < count; ++i) {
    Vec3d corners[3];
    for (int k = 0; k < 3; ++k) corners[k] = mesh.vertices[mesh.triangles[number_[i]][k]];
    const Triangle& triangle = triangles_.emplace_back(corners[0], corners[1], corners[2]);
    if (!triangle.cornersIfNotThin()) continue;
    for (Vec3d& corner : corners) corner = to_unit_ * (corner - centre_);
    Leaf& leaf = leaves_[i / kWidth];
    const Vec3d face = unit(cross(corners[1] - corners[0], corners[2] - corners[0]));
    leaf.faces.set(i % kWidth, face, corners[0]);
    for (int k = 0; k < 3; ++k)
      leaf.edges[k].set(i % kWidth, unit(cross(face, corners[(k + 1) % 3] - corners[k])), corners[k]);
  }
}

/// A ball, in float: what is certainly beyond need not be looked at.
class ClosestTriangle::Reach {
 public:
  Reach(const ClosestTriangle& tree, const Vec3d& centre, double radius) : tree_(tree) {
    moveTo(centre);
    shrinkTo(radius);
  }
  void moveTo(const Vec3d& centre) {
    const Vec3d q = tree_.to_unit_ * (centre - tree_.centre_);
    slack_ = kFloatSlack * (1 + std::max({std::abs(q[0]), std::abs(q[1]), std::abs(q[2])}));
    for (int axis = 0; axis < 3; ++axis) centre_[axis] = FourFloats{} + static_cast<float>(q[axis]);
  }
  void shrinkTo(double radius) {
    const double reach = radius * tree_.to_unit_ * (1 + kFloatSlack) + slack_;
    limit_ = roundedUp(reach * reach);
  }
  float limit() const { return limit_; }  ///< of squared distances
  /// A bit for each of the first ones that is not beyond the limit.
  unsigned within(FourFloats squared, std::uint32_t size) const {
    return ~signBits(squared > limit_) & ((1u << size) - 1);
  }
  FourFloats squaredTo(const Node& node) const {
    FourFloats squared{};
    for (int axis = 0; axis < 3; ++axis) {
      const FourFloats away =
          larger(larger(node.low[axis] - centre_[axis], centre_[axis] - node.high[axis]), FourFloats{});
      squared += away * away;
    }
    return squared;
  }
  FourFloats squaredTo(const Leaf& leaf) const {
    FourFloats beside{};
    for (const Planes& edge : leaf.edges) beside = larger(beside, -edge.heights(centre_));
    const FourFloats height = leaf.faces.heights(centre_);
    return height * height + beside * beside;
  }

 private:
  const ClosestTriangle& tree_;
  double slack_ = 0;
  FourFloats centre_[3];
  float limit_ = 0;
};

template <class Look>
void ClosestTriangle::visitWithin(const Reach& reach, const Look& look) const {
  struct Entry {
    std::uint32_t child;
    float squared;
  };
  // Children are of equal size, so the tree has less than 16 levels, of which each leaves up to three open.
  std::array<Entry, 3 * 16 + 1> open;
  std::size_t count = 0;
  Entry next{nodes_.empty() ? kLeaf : static_cast<std::uint32_t>(nodes_.size() - 1), 0};
  const auto takeOpen = [&] {
    while (count > 0) {
      next = open[--count];
      if (next.squared <= reach.limit()) return true;
    }
    return false;
  };
  // Always on with the nearest child. The others stay open, in any order: to sort them takes longer.
  const auto goToLeaf = [&] {
    while (!(next.child & kLeaf)) {
      const Node& node = nodes_[next.child];
      const FourFloats squared = reach.squaredTo(node);
      unsigned near = reach.within(squared, node.count);
      if (near == 0) return false;
      const auto entry = [&] {
        const auto k = static_cast<std::uint32_t>(std::countr_zero(near));
        return Entry{node.children[k], squared[k]};
      };
      next = entry();
      for (near &= near - 1; near != 0; near &= near - 1) {
        Entry other = entry();
        if (other.squared < next.squared) std::swap(other, next);
        open[count++] = other;
      }
    }
    return true;
  };
  for (bool more = !leaves_.empty(); more; more = takeOpen()) {
    if (!goToLeaf()) continue;
    const std::uint32_t first = (next.child & ~kLeaf) * kWidth;
    const Leaf& leaf = leaves_[first / kWidth];
    fetch(&triangles_[first], kWidth * sizeof(Triangle));
    FourFloats squared = reach.squaredTo(leaf);
    const auto size = std::min(kWidth, static_cast<std::uint32_t>(triangles_.size()) - first);
    for (unsigned near = reach.within(squared, size); near != 0; near &= reach.within(squared, size)) {
      // The nearest first.
      auto k = std::countr_zero(near);
      for (unsigned rest = near & (near - 1); rest != 0; rest &= rest - 1) {
        if (squared[std::countr_zero(rest)] < squared[k]) k = std::countr_zero(rest);
      }
      near &= ~(1u << k);
      if (!look(first + static_cast<std::uint32_t>(k))) continue;
      squared = reach.squaredTo(leaf);
      for (std::size_t i = 0; i < count; ++i) open[i].squared = 0;  // the old centre tells nothing
    }
  }
}

ClosestTriangle::Nearest ClosestTriangle::closest(const Vec3d& p, double cutoff) const {
  Reach reach(*this, p, cutoff);
  double best2 = std::numeric_limits<double>::infinity();
  std::uint32_t best = 0;
  Vec3d nearest{};
  visitWithin(reach, [&](std::uint32_t i) {
    Vec3d point;
    const double d2 = triangles_[i].closest(p, point);
    if (d2 > best2 || (d2 == best2 && number_[i] > number_[best])) return false;
    best2 = d2;
    best = i;
    nearest = point;
    reach.shrinkTo(std::sqrt(d2));
    return false;
  });
  const double distance = std::sqrt(best2);
  if (!(distance <= cutoff)) return {{std::numeric_limits<double>::infinity(), {}}};
  return {{distance, nearest}, &triangles_[best]};
}

double ClosestTriangle::emptyRadius(const Vec3d& at, const Vec3d& side, double least, double most) const {
  double radius = most;
  Reach reach(*this, at + radius * side, radius);
  visitWithin(reach, [&](std::uint32_t i) {
    const double before = radius;
    while (radius >= least) {
      const Vec3d middle = at + radius * side;
      Vec3d point;
      if (std::sqrt(triangles_[i].closest(middle, point)) >= kEmpty * radius) break;
      // The ball through both points.
      const Vec3d way = point - at;
      radius = dot(way, way) / (2 * dot(way, side));
    }
    if (radius == before) return false;
    reach.moveTo(at + radius * side);
    reach.shrinkTo(radius < least ? 0 : radius);
    return true;
  });
  return radius < least ? 0 : radius;
}

int ClosestTriangle::sideOf(const Vec3d& p, const Triangle& nearest, bool gentle) const {
  const double front = nearest.inFront(p, gentle);
  const double rounding = 1e-10 * (1 / to_unit_ + norm(p));
  return std::abs(front) <= rounding ? 0 : front > 0 ? 1 : -1;
}

}  // namespace innersphere
