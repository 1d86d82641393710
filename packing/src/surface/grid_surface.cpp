#include "surface/grid_surface.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "surface/box.hpp"
#include "surface/kernels.hpp"

namespace innersphere {

using Lanes = SurfaceTree::Lanes;

double Similarity::scale() const {
  return norm(Vec3d{matrix.m[0], matrix.m[1], matrix.m[2]});
}

Similarity Similarity::inverse() const {
  const Vec3d row{matrix.m[0], matrix.m[1], matrix.m[2]};
  const core::Mat3<double> back = core::scaled(core::transposed(matrix), 1 / dot(row, row));
  return {back, back * -translation};
}

Similarity after(const Similarity& a, const Similarity& b) {
  return {core::product(a.matrix, b.matrix), a(b.translation)};
}

void GridSurface::begin(const SurfaceTree& tree, const SurfaceTree& other, const Similarity& placed,
                        const Similarity& in_other, double cells, Moved moved, bool wide) {
  tree_ = &tree;
  to_grid_ = {core::scaled(placed.matrix, cells), cells * placed.translation};
  other_ = &other;
  const SurfaceTree::CoarseGrid& grid = other.grid();
  for (int i = 0; i < 9; ++i) {
    const auto m = static_cast<float>(grid.per * in_other.matrix.m[i]);
    to_other_.matrix[i % 3][i / 3] = Lanes{} + m;
    to_other_.absolute[i % 3][i / 3] = Lanes{} + std::abs(m);
  }
  const Vec3d t = grid.per * (in_other.translation - grid.middle);
  for (int k = 0; k < 3; ++k) to_other_.translation[k] = Lanes{} + static_cast<float>(t[k]);
  to_other_.slack = static_cast<float>(
      kSingleRounding * std::max(grid.per * in_other.scale() * largest(tree.bounds()), largest(t)));
  wide_ = wide;
  cells_ = cells;
  moved_ = moved;
  asked_ = 0;
  if (++query_ == 0) {
    nodes_.clear();
    marks_.clear();
    query_ = 1;
  }
  if (nodes_.size() < tree.nodes().size()) nodes_.resize(tree.nodes().size());
  if (marks_.size() < tree.triangles().size()) marks_.resize(tree.triangles().size());
  triangles_.clear();
  segments_.clear();
  crossings_.assign(1, {});
}

Vec3d GridSurface::vertex(Index v) const {
  const Lanes& p = tree_->vertices()[v];
  Vec3d at = to_grid_({p[0], p[1], p[2]});
  for (double& x : at) x = (x + kWhole) - kWhole;
  return at;
}

/// Places what is asked for.
template <class Kernels>
struct GridSurface::Placing {
  static void corners(const GridSurface& of, const SurfaceTree::Triangle& v, CornerPlaces& corners) {
    const Lanes* const vertices = of.tree_->vertices().data();
    Kernels::place(vertices[v[0]], vertices[v[1]], vertices[v[2]], of.to_grid_, corners);
  }
  static void triangle(GridSurface& of, Index index) {
    of.marks_[index] = {of.query_, static_cast<Index>(of.triangles_.size()), 0};
    Triangle& t = of.triangles_.emplace_back(of.tree_->triangles()[index], index);
    corners(of, t.vertices, t);
    t.findPlane();
  }
  static void node(GridSurface& of, Index index) {
    const SurfaceTree::Node& node = of.tree_->nodes()[index];
    Node& placed = of.nodes_[index];
    static_cast<SurfaceTree::Links&>(placed) = node;
    placed.query = of.query_;
    Kernels::place(node, of.to_other_, of.moved_ == Moved::point, placed);
  }
};

#ifdef INNERSPHERE_AVX512_SURFACE
/// All that belongs together is one function: calls take as long as what they do.
struct GridSurface::WidePlacing {
  using Placing = GridSurface::Placing<Avx512Kernels>;
  INNERSPHERE_AVX512_SURFACE static void corners(const GridSurface& of, const SurfaceTree::Triangle& v,
                                                 CornerPlaces& corners) {
    Placing::corners(of, v, corners);
  }
  INNERSPHERE_AVX512_SURFACE static void triangle(GridSurface& of, Index i) { Placing::triangle(of, i); }
  INNERSPHERE_AVX512_SURFACE static void node(GridSurface& of, Index i) { Placing::node(of, i); }
};
#endif

void GridSurface::placeCorners(const SurfaceTree::Triangle& v, CornerPlaces& corners) const {
#ifdef INNERSPHERE_AVX512_SURFACE
  if (wide_) return WidePlacing::corners(*this, v, corners);
#endif
  Placing<AnyKernels>::corners(*this, v, corners);
}

void GridSurface::placeTriangle(Index triangle) {
#ifdef INNERSPHERE_AVX512_SURFACE
  if (wide_) return WidePlacing::triangle(*this, triangle);
#endif
  Placing<AnyKernels>::triangle(*this, triangle);
}

void GridSurface::placeNode(Index index) {
#ifdef INNERSPHERE_AVX512_SURFACE
  if (wide_) return WidePlacing::node(*this, index);
#endif
  Placing<AnyKernels>::node(*this, index);
}

int GridSurface::windingAt(const Vec3d& point) {
  ++asked_;
  int winding = 0;
  // What is above or below the point, in the frame of the first surface: the shorter way out.
  const bool is_first = moved_ == Moved::point, up = point.z > to_grid_(tree_->grid().middle).z;
  const SurfaceTree::CoarseGrid& grid = (is_first ? tree_ : other_)->grid();
  const Vec3d at = grid.per * ((1 / cells_) * point - grid.middle);
  FourInts way[3];
  for (int k = 0; k < 3; ++k) {
    const Lanes here = Lanes{} + static_cast<float>(at[k]), end = Lanes{} + grid.kEnd;
    way[k] = grid.sides(k == 2 && up ? end : here, k == 2 && !up ? end : -here);
    if (is_first) way[k] = exchangedHalves(way[k]);
  }
  open_.assign(1, 0);
  while (!open_.empty()) {
    const Index index = open_.back();
    open_.pop_back();
    const Node& node = this->node(index);
    for (Index met = node.meeting(way) & ((1U << node.count) - 1); met != 0; met &= met - 1) {
      const Index child = node.children[std::countr_zero(met)];
      if (!node.are_triangles) {
        open_.push_back(child);
        continue;
      }
      // A triangle that is in several boxes counts once.
      const Index place = find(child);
      if (std::exchange(marks_[child].asked, asked_) == asked_) continue;
      winding += windingSeen(triangles_[place], point, moved_, up);
    }
  }
  return winding;
}

}  // namespace innersphere
