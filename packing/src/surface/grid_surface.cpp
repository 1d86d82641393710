#include "surface/grid_surface.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "surface/box.hpp"

namespace innersphere {

namespace {

using Lanes = SurfaceTree::Lanes;

/// What rounding to single precision may do to a place, by the largest coordinate.
constexpr double kSingleRounding = 2e-6;

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

void GridSurface::begin(const SurfaceTree& tree, const Similarity& placed, const Similarity& in_other,
                        double cells, Moved moved) {
  tree_ = &tree;
  to_grid_ = {core::scaled(placed.matrix, cells), cells * placed.translation};
  for (int i = 0; i < 9; ++i) {
    matrix_.m[i] = static_cast<float>(in_other.matrix.m[i]);
    absolute_.m[i] = std::abs(matrix_.m[i]);
  }
  const Vec3d& t = in_other.translation;
  translation_ = {static_cast<float>(t.x), static_cast<float>(t.y), static_cast<float>(t.z)};
  const double own_reach = std::max(largest(tree.bounds().min), largest(tree.bounds().max));
  const double reach = std::max(in_other.scale() * own_reach, largest(t));
  slack_ = static_cast<float>(kSingleRounding * reach);
  grid_slack_ = static_cast<float>(kSingleRounding * (moved == Moved::point ? own_reach : reach));
  cells_ = cells;
  moved_ = moved;
  asked_ = 0;
  if (++query_ == 0) {
    vertices_.clear();
    boxes_.clear();
    marks_.clear();
    query_ = 1;
  }
  if (vertices_.size() < tree.vertices().size()) vertices_.resize(tree.vertices().size());
  if (boxes_.size() < tree.nodes().size()) boxes_.resize(tree.nodes().size());
  if (marks_.size() < tree.triangles().size()) marks_.resize(tree.triangles().size());
  triangles_.clear();
  segments_.clear();
  crossings_.clear();
}

void GridSurface::place(Index v) {
  const Vec3f& p = tree_->vertices()[v];
  const Vec3d at = to_grid_({p.x, p.y, p.z});
  vertices_[v] = {query_, {rounded(at.x), rounded(at.y), rounded(at.z)}};
}

void GridSurface::placeTriangle(Index triangle) {
  marks_[triangle] = {query_, static_cast<Index>(triangles_.size()), 0};
  const SurfaceTree::Triangle& v = tree_->triangles()[triangle];
  triangles_.push_back({GridTriangle(vertex(v[0]), vertex(v[1]), vertex(v[2])), v});
}

void GridSurface::placeBoxes(Index index) {
  boxes_[index].query = query_;
  LaneBoxes& boxes = boxes_[index].boxes;
  const SurfaceTree::Node& node = tree_->nodes()[index];
  for (int k = 0; k < 3; ++k) {
    const float *m = matrix_.m + 3 * k, *size = absolute_.m + 3 * k;
    boxes.centre[k] = m[0] * node.centre[0] + m[1] * node.centre[1] + m[2] * node.centre[2] + translation_[k];
    boxes.half[k] = size[0] * node.half[0] + size[1] * node.half[1] + size[2] * node.half[2] + slack_;
  }
  if (!node.are_triangles) return;
  // Those around whole triangles are smaller, unless these are in several.
  Lanes corners[3][3];
  for (Index i = 0; i < SurfaceTree::kWidth; ++i) {
    const SurfaceTree::Triangle& t = tree_->triangles()[node.children[std::min(i, node.count - 1)]];
    for (int c = 0; c < 3; ++c) {
      for (int k = 0; k < 3; ++k) corners[c][k][i] = tree_->vertices()[t[c]][k];
    }
  }
  for (int k = 0; k < 3; ++k) {
    const float* m = matrix_.m + 3 * k;
    Lanes along[3];
    for (int c = 0; c < 3; ++c)
      along[c] = m[0] * corners[c][0] + m[1] * corners[c][1] + m[2] * corners[c][2] + translation_[k];
    const Lanes low = lesser(lesser(along[0], along[1]), along[2]) - slack_,
                high = larger(larger(along[0], along[1]), along[2]) + slack_;
    const Lanes from = larger(low, boxes.centre[k] - boxes.half[k]),
                to = lesser(high, boxes.centre[k] + boxes.half[k]);
    boxes.centre[k] = (to + from) / 2;
    boxes.half[k] = (to - from) / 2;
  }
}

int GridSurface::windingAt(const Vec3d& point) {
  ++asked_;
  int winding = 0;
  // Boxes are those of the frame in which the grid is.
  const bool is_first = moved_ == Moved::point;
  const Vec3d at = (1 / cells_) * point;
  const auto x = static_cast<float>(at.x), y = static_cast<float>(at.y), z = static_cast<float>(at.z);
  const Lanes slack = Lanes{} + grid_slack_ + static_cast<float>(kSingleRounding * largest(at));
  open_.assign(1, 0);
  while (!open_.empty()) {
    const Index index = open_.back();
    open_.pop_back();
    const SurfaceTree::Node& node = tree_->nodes()[index];
    const Lanes* centre = is_first ? node.centre : boxesInOther(index).centre;
    const Lanes* half = is_first ? node.half : boxesInOther(index).half;
    const auto meets = (centre[0] - half[0] <= x + slack) & (centre[0] + half[0] >= x - slack) &
                       (centre[1] - half[1] <= y + slack) & (centre[1] + half[1] >= y - slack) &
                       (centre[2] + half[2] >= z - slack);
    for (Index k = 0; k < node.count; ++k) {
      if (meets[k] == 0) continue;
      if (!node.are_triangles) {
        open_.push_back(node.children[k]);
        continue;
      }
      // A triangle that is in several boxes counts once.
      const Index place = find(node.children[k]);
      if (std::exchange(marks_[node.children[k]].asked, asked_) == asked_) continue;
      winding += windingBelow(triangles_[place], point, moved_);
    }
  }
  return winding;
}

}  // namespace innersphere
