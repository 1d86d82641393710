#include "surface/grid_surface.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "surface/box.hpp"

namespace innersphere {

namespace {

using Lanes = SurfaceTree::Lanes;

/// Both sides of what is behind the end of any coarse grid.
constexpr std::int32_t kNoBox = -16384 * 0x10001;

/// Returns the numbers with their halves exchanged.
FourInts exchanged(FourInts x) {
  return (x << 16) | ((x >> 16) & 0xffff);
}

/// Returns as columns the first three of each place's coordinates.
void asColumns(const Lanes (&places)[4], Lanes (&columns)[3]) {
  const auto firstOf = [](Lanes a, Lanes b) { return Lanes{a[0], b[0], a[1], b[1]}; };
  const auto lastOf = [](Lanes a, Lanes b) { return Lanes{a[2], b[2], a[3], b[3]}; };
  const Lanes a = firstOf(places[0], places[1]), b = firstOf(places[2], places[3]),
              c = lastOf(places[0], places[1]), d = lastOf(places[2], places[3]);
  columns[0] = Lanes{a[0], a[1], b[0], b[1]};
  columns[1] = Lanes{a[2], a[3], b[2], b[3]};
  columns[2] = Lanes{c[0], c[1], d[0], d[1]};
}

/// Returns the nearest whole number. Numbers are less than 2^51.
double rounded(double x) {
  constexpr double kWhole = 0x1.8p52;
  return (x + kWhole) - kWhole;
}

}  // namespace

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
                        const Similarity& in_other, double cells, Moved moved) {
  tree_ = &tree;
  to_grid_ = {core::scaled(placed.matrix, cells), cells * placed.translation};
  other_ = &other;
  const SurfaceTree::CoarseGrid& grid = other.grid();
  for (int i = 0; i < 9; ++i) {
    const auto m = static_cast<float>(grid.per * in_other.matrix.m[i]);
    matrix_[i] = Lanes{} + m;
    absolute_[i] = Lanes{} + std::abs(m);
  }
  const Vec3d t = grid.per * (in_other.translation - grid.middle);
  for (int k = 0; k < 3; ++k) translation_[k] = Lanes{} + static_cast<float>(t[k]);
  slack_ = static_cast<float>(kSingleRounding *
                              std::max(grid.per * in_other.scale() * largest(tree.bounds()), largest(t)));
  cells_ = cells;
  moved_ = moved;
  asked_ = 0;
  if (++query_ == 0) {
    vertices_.clear();
    nodes_.clear();
    marks_.clear();
    query_ = 1;
  }
  if (vertices_.size() < tree.vertices().size()) vertices_.resize(tree.vertices().size());
  if (nodes_.size() < tree.nodes().size()) nodes_.resize(tree.nodes().size());
  if (marks_.size() < tree.triangles().size()) marks_.resize(tree.triangles().size());
  triangles_.clear();
  segments_.clear();
  crossings_.clear();
}

void GridSurface::place(Index v) {
  const Lanes& p = tree_->vertices()[v];
  const Vec3d at = to_grid_({p[0], p[1], p[2]});
  vertices_[v] = {query_, {rounded(at.x), rounded(at.y), rounded(at.z)}};
}

void GridSurface::placeTriangle(Index triangle) {
  marks_[triangle] = {query_, static_cast<Index>(triangles_.size()), 0};
  const SurfaceTree::Triangle& v = tree_->triangles()[triangle];
  triangles_.emplace_back(vertex(v[0]), vertex(v[1]), vertex(v[2]), v);
}

void GridSurface::placeNode(Index index) {
  const SurfaceTree::Node& node = tree_->nodes()[index];
  constexpr float kFar = std::numeric_limits<float>::infinity();
  Lanes low[3], high[3];
  for (int k = 0; k < 3; ++k) low[k] = Lanes{} - kFar, high[k] = Lanes{} + kFar;
  // Boxes around whole triangles are smaller than around their boxes, unless these are of parts.
  if (!node.are_triangles || node.in_several != 0) {
    for (int k = 0; k < 3; ++k) {
      const Lanes *m = matrix_ + 3 * k, *size = absolute_ + 3 * k;
      const Lanes centre =
          m[0] * node.centre[0] + m[1] * node.centre[1] + m[2] * node.centre[2] + translation_[k];
      const Lanes half = size[0] * node.half[0] + size[1] * node.half[1] + size[2] * node.half[2];
      low[k] = centre - half;
      high[k] = centre + half;
    }
  }
  if (node.are_triangles) {
    Lanes corners[3][3];
    for (int c = 0; c < 3; ++c) {
      Lanes places[SurfaceTree::kWidth];
      for (Index i = 0; i < SurfaceTree::kWidth; ++i)
        places[i] = tree_->vertices()[tree_->triangles()[node.children[i]][c]];
      asColumns(places, corners[c]);
    }
    for (int k = 0; k < 3; ++k) {
      const Lanes* m = matrix_ + 3 * k;
      Lanes along[3];
      for (int c = 0; c < 3; ++c)
        along[c] = m[0] * corners[c][0] + m[1] * corners[c][1] + m[2] * corners[c][2] + translation_[k];
      low[k] = larger(low[k], lesser(lesser(along[0], along[1]), along[2]));
      high[k] = lesser(high[k], larger(larger(along[0], along[1]), along[2]));
    }
  }
  Node& placed = nodes_[index];
  static_cast<SurfaceTree::Links&>(placed) = node;
  placed.query = query_;
  FourInts* sides = placed.sides;
  const bool is_first = moved_ == Moved::point;
  for (int k = 0; k < 3; ++k) {
    const FourInts there = other_->grid().sides(high[k] + slack_, slack_ - low[k]);
    sides[k] = is_first ? node.sides[k] : exchanged(there);
    sides[3 + k] = is_first ? there : exchanged(node.sides[k]);
  }
  for (Index i = node.count; i < SurfaceTree::kWidth; ++i) sides[0][i] = sides[3][i] = kNoBox;
}

int GridSurface::windingAt(const Vec3d& point) {
  ++asked_;
  int winding = 0;
  // What is above the point, in the frame of the first surface.
  const bool is_first = moved_ == Moved::point;
  const SurfaceTree::CoarseGrid& grid = (is_first ? tree_ : other_)->grid();
  const Vec3d at = grid.per * ((1 / cells_) * point - grid.middle);
  LaneBoxes above;
  for (int k = 0; k < 3; ++k) {
    const Lanes here = Lanes{} + static_cast<float>(at[k]);
    above.sides[k] = grid.sides(k < 2 ? here : Lanes{} + grid.kEnd, -here);
    if (is_first) above.sides[k] = exchanged(above.sides[k]);
  }
  open_.assign(1, 0);
  while (!open_.empty()) {
    const Index index = open_.back();
    open_.pop_back();
    const Node& node = this->node(index);
    for (Index met = node.meeting(above, 0, 3); met != 0; met &= met - 1) {
      const Index child = node.children[std::countr_zero(met)];
      if (!node.are_triangles) {
        open_.push_back(child);
        continue;
      }
      // A triangle that is in several boxes counts once.
      const Index place = find(child);
      if (std::exchange(marks_[child].asked, asked_) == asked_) continue;
      winding += windingBelow(triangles_[place], point, moved_);
    }
  }
  return winding;
}

}  // namespace innersphere
