#include "surface/surface_meeting.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace innersphere {

namespace {

using Index = GridSurface::Index;
using Node = GridSurface::Node;

/// Returns which of the children of a node of x reach into a node of y, a bit for each.
inline Index meeting(const Node& of_x, GridSurface& y, Index of_y) {
  if (of_y == 0) return (1U << of_x.count) - 1;
  const Node& node = y.node(of_y);
  return of_x.meeting(y.node(node.parent), node.place);
}

template <typename F>
void forBits(Index bits, const F& f) {
  for (; bits != 0; bits &= bits - 1) f(static_cast<Index>(std::countr_zero(bits)));
}

/// Adds where an edge of x crosses the other surface. Returns the place.
Vec3d cross(GridSurface& surface, GridSurface::Triangle& x, const Corners& corners, int edge) {
  const int next = Corners::next(edge);
  // Both triangles at an edge find the same place.
  const bool forward = x.vertices[edge] < x.vertices[next];
  const int low = forward ? edge : next, high = forward ? next : edge;
  const double height = corners.heights[low], fall = height - corners.heights[high];
  const double part = fall != 0 ? std::clamp(height / fall, 0.0, 1.0) : 0.5;
  const Vec3d from = x.corner(low), at = from + part * (x.corner(high) - from);
  const int change = corners.isAbove(edge) ? 1 : -1;
  surface.addCrossing(x, at, edge, change);
  return at;
}

/// Adds what two triangles have in common: a segment of the line in which their planes meet.
void meet(GridSurface& a, Index of_a, GridSurface& b, Index of_b) {
  GridSurface::Triangle &t = a.at(a.find(of_a)), &u = b.at(b.find(of_b));
  const Corners at_t(t, u, Moved::point);
  if (at_t.alone < 0) return;
  const Corners at_u(u, t, Moved::triangle);
  if (at_u.alone < 0) return;
  // Two edges of each cross the line. In the direction normal of t x normal of u one is the first: that from
  // the corner that is alone, or that to it.
  const bool first_t = !at_u.isAbove(at_u.alone), first_u = at_t.isAbove(at_t.alone);
  const EdgeOrder order(t, at_u, u, at_t);
  if (!order.comesBefore(first_t, !first_u) || order.comesBefore(!first_t, first_u)) return;
  const auto crossU = [&](bool from_alone) { return cross(b, u, at_t, at_t.edge(from_alone)); };
  const auto crossT = [&](bool from_alone) { return cross(a, t, at_u, at_u.edge(from_alone)); };
  const Vec3d from = order.comesBefore(first_t, first_u) ? crossU(first_u) : crossT(first_t);
  const Vec3d to = order.comesBefore(!first_t, !first_u) ? crossT(!first_t) : crossU(!first_u);
  a.addSegment(t, from, to);
  b.addSegment(u, to, from);
}

}  // namespace

void findMeeting(GridSurface& a, GridSurface& b) {
  using Pair = std::pair<Index, Index>;
  static thread_local std::vector<Pair> open;
  static thread_local std::vector<std::uint64_t> repeated;
  open.assign(1, {0, 0});
  repeated.clear();
  while (!open.empty()) {
    const Pair pair = open.back();
    open.pop_back();
    const Node &of_a = a.node(pair.first), &of_b = b.node(pair.second);
    // A node of triangles stays as it is while the other one is taken apart.
    if (of_a.are_triangles && !of_b.are_triangles) {
      forBits(meeting(of_b, a, pair.first),
              [&](Index j) { open.emplace_back(pair.first, of_b.children[j]); });
      continue;
    }
    const Index met = meeting(of_a, b, pair.second);
    if (of_b.are_triangles && !of_a.are_triangles) {
      forBits(met, [&](Index i) { open.emplace_back(of_a.children[i], pair.second); });
      continue;
    }
    forBits(met, [&](Index i) {
      forBits(of_b.meeting(of_a, i), [&](Index j) {
        const Index child_a = of_a.children[i], child_b = of_b.children[j];
        if (!of_a.are_triangles) {
          open.emplace_back(child_a, child_b);
        } else if (((of_a.in_several >> i | of_b.in_several >> j) & 1) != 0) {
          repeated.push_back(std::uint64_t{child_a} << 32 | child_b);
        } else {
          meet(a, child_a, b, child_b);
        }
      });
    });
  }
  // Several of their boxes meet, but they do once.
  std::sort(repeated.begin(), repeated.end());
  repeated.erase(std::unique(repeated.begin(), repeated.end()), repeated.end());
  for (const std::uint64_t pair : repeated)
    meet(a, static_cast<Index>(pair >> 32), b, static_cast<Index>(pair));
}

}  // namespace innersphere
