#include "surface/surface_view.hpp"

#include <cmath>
#include <iterator>

namespace innersphere {

namespace {

/// Returns whether the point is to the left of the way from a to b, seen from above; for the way back the
/// opposite, to the bit, so that of two triangles at an edge one has the point.
bool isLeft(const Vec3d& a, const Vec3d& b, const Vec3d& p) {
  const bool forward = a.x != b.x ? a.x < b.x : a.y < b.y;
  const Vec3d &from = forward ? a : b, &to = forward ? b : a;
  const double side = (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
  return (side >= 0) == forward;
}

bool isInColumnOf(const Vec3d& p, const ColumnTriangle& t) {
  const Vec3d* c = t.corners;
  const bool left = isLeft(c[0], c[1], p);
  return left == (t.side > 0) && isLeft(c[1], c[2], p) == left && isLeft(c[2], c[0], p) == left;
}

bool isBelow(const Vec3d& p, const ColumnTriangle& t) {
  return dot(t.normal, p - t.corners[0]) * t.side < 0;
}

}  // namespace

SurfaceView::SurfaceView(const PlacedSurface& surface, const core::Mat3<double>& frame)
    : tree_(surface.tree),
      matrix_(core::product(frame, surface.matrix)),
      translation_(frame * surface.translation) {
  std::transform(std::begin(matrix_.m), std::end(matrix_.m), std::begin(absolute_.m),
                 [](double x) { return std::abs(x); });
}

Bounds SurfaceView::bounds() const {
  const Bounds& own = tree_.bounds();
  const Vec3d centre = matrix_ * (0.5 * (own.min + own.max)) + translation_;
  const Vec3d half = absolute_ * (0.5 * (own.max - own.min));
  return {centre - half, centre + half};
}

/// Returns the boxes of a node's children.
SurfaceView::LaneBoxes SurfaceView::boxes(const SurfaceTree::Node& node) const {
  LaneBoxes all;
  for (int k = 0; k < 3; ++k) {
    const double *m = matrix_.m + 3 * k, *size = absolute_.m + 3 * k;
    const Lanes centre =
        m[0] * node.centre[0] + m[1] * node.centre[1] + m[2] * node.centre[2] + translation_[k];
    const Lanes half = size[0] * node.half[0] + size[1] * node.half[1] + size[2] * node.half[2];
    all.min[k] = centre - half;
    all.max[k] = centre + half;
  }
  return all;
}

/// Calls leaf(first triangle, end) for leaves whose boxes meet `box`.
template <typename Leaf>
void SurfaceView::visit(const Bounds& box, std::uint32_t index, const Leaf& leaf) const {
  const SurfaceTree::Node& node = tree_.nodes()[index];
  const LaneBoxes b = boxes(node);
  const auto meets = (b.min[0] <= box.max.x) & (b.max[0] >= box.min.x) & (b.min[1] <= box.max.y) &
                     (b.max[1] >= box.min.y) & (b.min[2] <= box.max.z) & (b.max[2] >= box.min.z);
  for (std::size_t k = 0; k < SurfaceTree::kWidth; ++k) {
    if (meets[k] == 0) continue;
    const SurfaceTree::Child& child = node.children[k];
    if (child.isLeaf()) {
      leaf(child.first, child.first + child.count);
    } else {
      visit(box, child.first, leaf);
    }
  }
}

ColumnTriangle SurfaceView::triangle(std::uint32_t index) const {
  const SurfaceTree::Triangle& t = tree_.triangles()[index];
  return makeColumnTriangle(place(t[0]), place(t[1]), place(t[2]));
}

std::vector<ColumnTriangle> SurfaceView::trianglesIn(const Bounds& box) const {
  std::vector<ColumnTriangle> found;
  visit(box, 0, [&](std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t i = first; i < end; ++i) {
      const ColumnTriangle t = triangle(i);
      if (t.side != 0 && !isEmpty(common(t.box, box))) found.push_back(t);
    }
  });
  return found;
}

/// Returns bounds of the part of the surface that is in the box.
Bounds SurfaceView::surfaceIn(const Bounds& box) const {
  Bounds found = nothing();
  gather(0, box, found);
  return found;
}

void SurfaceView::gather(std::uint32_t index, const Bounds& box, Bounds& found) const {
  const SurfaceTree::Node& node = tree_.nodes()[index];
  const LaneBoxes b = boxes(node);
  for (std::size_t k = 0; k < SurfaceTree::kWidth; ++k) {
    const Bounds part =
        common({{b.min[0][k], b.min[1][k], b.min[2][k]}, {b.max[0][k], b.max[1][k], b.max[2][k]}}, box);
    if (isEmpty(part) || isWithin(part, found)) continue;
    const SurfaceTree::Child& child = node.children[k];
    if (!child.isLeaf()) {
      gather(child.first, box, found);
      continue;
    }
    for (std::uint32_t i = child.first; i < child.first + child.count; ++i) {
      Bounds triangle = nothing();
      for (const Vec3f& corner : tree_.triangles()[i]) include({place(corner), place(corner)}, triangle);
      const Bounds inside = common(triangle, box);
      if (!isEmpty(inside)) include(inside, found);
    }
  }
}

/// Returns how many more triangles above the point face up than down: how often it is in the solid.
int SurfaceView::windingAt(const Vec3d& point) const {
  int sum = 0;
  const Vec3d far{point.x, point.y, std::numeric_limits<double>::infinity()};
  visit({point, far}, 0, [&](std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t i = first; i < end; ++i) {
      const ColumnTriangle t = triangle(i);
      if (t.side != 0 && isInColumnOf(point, t) && isBelow(point, t)) sum += t.side;
    }
  });
  return sum;
}

Bounds SurfaceView::shrunk(const Bounds& box) const {
  const Bounds surface = surfaceIn(box);
  const bool empty = isEmpty(surface);
  // A side that the surface does not reach is all inside or all outside, and so are sides that meet at it.
  const auto isFree = [&](int side) {
    const int k = side / 2;
    return empty || (side % 2 == 0 ? surface.min[k] > box.min[k] : surface.max[k] < box.max[k]);
  };
  int winding[8];
  bool known[8] = {};
  Bounds result = box;
  for (int side = 0; side < 6; ++side) {
    if (!isFree(side)) continue;
    int corner = 0;
    for (int k = 0; k < 3; ++k) {
      const bool high = k == side / 2 ? side % 2 == 1 : !isFree(2 * k);
      if (high) corner |= 1 << k;
    }
    if (!known[corner]) {
      Vec3d point;
      for (int k = 0; k < 3; ++k) point[k] = (corner >> k & 1) != 0 ? box.max[k] : box.min[k];
      winding[corner] = windingAt(point);
      known[corner] = true;
    }
    if (winding[corner] != 0) continue;
    if (empty) return nothing();
    const int k = side / 2;
    (side % 2 == 0 ? result.min : result.max)[k] = (side % 2 == 0 ? surface.min : surface.max)[k];
  }
  return result;
}

}  // namespace innersphere
