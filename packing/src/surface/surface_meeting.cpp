#include "surface/surface_meeting.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace innersphere {

namespace {

using Index = GridSurface::Index;
using Lanes = SurfaceTree::Lanes;
using Node = SurfaceTree::Node;

/// This is a node with its children's boxes in both frames.
struct PlacedNode {
  PlacedNode(GridSurface& surface, Index index)
      : node(surface.tree().nodes()[index]), in_other(surface.boxesInOther(index)) {}
  const Node& node;
  const LaneBoxes& in_other;
};

/// Returns which of x's children reach into a child of y, a bit for each: their boxes meet in both frames.
Index meeting(const PlacedNode& x, const PlacedNode& y, Index child) {
  Lanes gap{};
  for (int k = 0; k < 3; ++k) {
    const Lanes in_x = x.node.centre[k] - y.in_other.centre[k][child],
                in_y = x.in_other.centre[k] - y.node.centre[k][child];
    gap = larger(gap, larger(in_x, -in_x) - (x.node.half[k] + y.in_other.half[k][child]));
    gap = larger(gap, larger(in_y, -in_y) - (x.in_other.half[k] + y.node.half[k][child]));
  }
  Index bits = 0;
  for (Index i = 0; i < x.node.count; ++i) bits |= Index{gap[i] <= 0} << i;
  return bits;
}

/// Returns which of the children of a node of x reach into a node of y.
Index meeting(const PlacedNode& x, GridSurface& y, Index node) {
  if (node == 0) return (1U << x.node.count) - 1;
  const Node& of_y = y.tree().nodes()[node];
  return meeting(x, PlacedNode(y, of_y.parent), of_y.place);
}

template <typename F>
void forBits(Index bits, const F& f) {
  for (; bits != 0; bits &= bits - 1) f(static_cast<Index>(std::countr_zero(bits)));
}

/// Adds where an edge of x crosses the other surface. Returns the place.
Vec3d cross(GridSurface& surface, GridSurface::Triangle& x, const Corners& corners, int edge) {
  const int next = (edge + 1) % 3;
  // Both triangles at an edge find the same place.
  const bool forward = x.vertices[edge] < x.vertices[next];
  const int low = forward ? edge : next, high = forward ? next : edge;
  const double height = corners.heights[low], fall = height - corners.heights[high];
  const double part = fall != 0 ? std::clamp(height / fall, 0.0, 1.0) : 0.5;
  const Vec3d at = x.corners[low] + part * (x.corners[high] - x.corners[low]);
  const int change = corners.above[edge] ? 1 : -1;
  surface.addCrossing(x, at, forward ? part : 1 - part, edge, change);
  return at;
}

/// Adds what two triangles have in common: a segment of the line in which their planes meet.
void meet(GridSurface& a, Index of_a, GridSurface& b, Index of_b) {
  GridSurface::Triangle &t = a.at(a.find(of_a)), &u = b.at(b.find(of_b));
  const Corners at_t = cornersAbove(t, u, Moved::point);
  if (at_t.alone < 0) return;
  const Corners at_u = cornersAbove(u, t, Moved::triangle);
  if (at_u.alone < 0) return;
  // Two edges of each cross the line. In the direction normal of t x normal of u one is the first.
  const bool high_u = at_t.above[at_t.alone], high_t = at_u.above[at_u.alone];
  const int first_t = at_u.edge(!high_t), last_t = at_u.edge(high_t);
  const int first_u = at_t.edge(high_u), last_u = at_t.edge(!high_u);
  const EdgeOrder order(t, at_u, u, at_t);
  if (!order.comesBefore(first_t, last_u) || order.comesBefore(last_t, first_u)) return;
  const Vec3d from =
      order.comesBefore(first_t, first_u) ? cross(b, u, at_t, first_u) : cross(a, t, at_u, first_t);
  const Vec3d to = order.comesBefore(last_t, last_u) ? cross(a, t, at_u, last_t) : cross(b, u, at_t, last_u);
  a.addSegment(t, from, to);
  b.addSegment(u, to, from);
}

}  // namespace

void findMeeting(GridSurface& a, GridSurface& b) {
  using Pair = std::pair<Index, Index>;
  static thread_local std::vector<Pair> open, repeated;
  open.assign(1, {0, 0});
  repeated.clear();
  const auto meetTriangles = [&](Index t, Index u) {
    if (a.tree().isInSeveralBoxes(t) || b.tree().isInSeveralBoxes(u)) {
      repeated.emplace_back(t, u);
    } else {
      meet(a, t, b, u);
    }
  };
  while (!open.empty()) {
    const Pair pair = open.back();
    open.pop_back();
    const PlacedNode of_a(a, pair.first), of_b(b, pair.second);
    const Node &node_a = of_a.node, &node_b = of_b.node;
    // A node of triangles stays as it is while the other one is taken apart.
    if (node_a.are_triangles && !node_b.are_triangles) {
      forBits(meeting(of_b, a, pair.first),
              [&](Index j) { open.emplace_back(pair.first, node_b.children[j]); });
      continue;
    }
    const Index met = meeting(of_a, b, pair.second);
    if (node_b.are_triangles && !node_a.are_triangles) {
      forBits(met, [&](Index i) { open.emplace_back(node_a.children[i], pair.second); });
      continue;
    }
    forBits(met, [&](Index i) {
      forBits(meeting(of_b, of_a, i), [&](Index j) {
        if (node_a.are_triangles) {
          meetTriangles(node_a.children[i], node_b.children[j]);
        } else {
          open.emplace_back(node_a.children[i], node_b.children[j]);
        }
      });
    });
  }
  // Several of their boxes meet, but they do once.
  std::sort(repeated.begin(), repeated.end());
  const auto end = std::unique(repeated.begin(), repeated.end());
  for (auto pair = repeated.begin(); pair != end; ++pair) meet(a, pair->first, b, pair->second);
}

}  // namespace innersphere
