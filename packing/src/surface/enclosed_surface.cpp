#include "surface/enclosed_surface.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace innersphere {

namespace {

using Index = GridSurface::Index;

/// Brings winding numbers in the other solid from vertex to vertex, as far as triangles are in it.
class Enclosure {
 public:
  EnclosedSums sum(GridSurface& own, GridSurface& other, const Vec3d& origin, bool volume_only);

 private:
  struct Vertex {
    Index query = 0;  ///< in which the winding number became known
    int winding;
  };

  void addAll();
  bool isKnown(Index v) const { return vertices_[v].query == query_; }
  void set(Index v, int winding);
  void startAt(Index vertex);
  void flood();
  void passThrough(Index triangle, int winding);
  int windingAlong(const GridSurface::Triangle& t, int from, int to) const;
  void addCut(const GridSurface::Triangle& t);
  void add(const Vec3d& a, const Vec3d& b, const Vec3d& c, double winding, const Vec3d& outwards);

  GridSurface* own_ = nullptr;
  GridSurface* other_ = nullptr;
  Vec3d origin_;
  bool volume_only_;
  EnclosedSums sums_;
  Index query_ = 0;
  std::vector<Vertex> vertices_;
  std::vector<Index> added_in_;  ///< the query in which a triangle was added as a whole
  std::vector<Index> open_;      ///< vertices from which to go on
  std::vector<char> is_cut_;     ///< of the parts of the surface
  std::vector<const Crossing*> along_;
};

EnclosedSums Enclosure::sum(GridSurface& own, GridSurface& other, const Vec3d& origin, bool volume_only) {
  own_ = &own;
  other_ = &other;
  origin_ = origin;
  volume_only_ = volume_only;
  sums_ = {};
  if (++query_ == 0) {
    vertices_.clear();
    added_in_.clear();
    query_ = 1;
  }
  vertices_.resize(std::max(vertices_.size(), own.tree().vertices().size()));
  added_in_.resize(std::max(added_in_.size(), own.tree().triangles().size()));
  addAll();
  return sums_;
}

/// Adds a triangle. It faces where `outwards` leads to, or it is taken away.
void Enclosure::add(const Vec3d& a, const Vec3d& b, const Vec3d& c, double winding, const Vec3d& outwards) {
  const Vec3d normal = winding * cross(b - a, c - a), from = a - origin_;
  const double cone = dot(from, normal);
  const Vec3d middle = from + (b - origin_) + (c - origin_);
  sums_.volume += cone;
  sums_.magnitude += std::abs(from.x * normal.x) + std::abs(from.y * normal.y) + std::abs(from.z * normal.z);
  sums_.moment = sums_.moment + cone * middle;
  if (volume_only_) return;
  sums_.area = sums_.area + normal;
  sums_.turning = sums_.turning + cross(middle, normal);
  sums_.wetted += std::copysign(norm(normal), dot(normal, outwards));
}

void Enclosure::addAll() {
  const SurfaceTree& tree = own_->tree();
  is_cut_.assign(tree.partCount(), 0);
  // Vertices of triangles that are cut are next to all that is in the other solid, but for whole parts.
  const std::size_t count = own_->foundCount();
  for (Index i = 0; i < count; ++i) {
    const GridSurface::Triangle& t = own_->at(i);
    if (!t.isCut()) continue;
    is_cut_[tree.partOf(t.vertices[0])] = 1;
    startAt(t.vertices[0]);
  }
  for (Index part = 0; part < tree.partCount(); ++part) {
    if (is_cut_[part] == 0) startAt(tree.vertexOfPart(part));
  }
  for (Index i = 0; i < count; ++i) {
    if (own_->at(i).isCut()) addCut(own_->at(i));
  }
}

void Enclosure::set(Index v, int winding) {
  if (isKnown(v)) return;
  vertices_[v] = {query_, winding};
  open_.push_back(v);
}

void Enclosure::startAt(Index vertex) {
  if (isKnown(vertex)) return;
  set(vertex, other_->windingAt(own_->vertex(vertex)));
  flood();
}

void Enclosure::flood() {
  const SurfaceTree& tree = own_->tree();
  while (!open_.empty()) {
    const Index from = open_.back();
    open_.pop_back();
    const int winding = vertices_[from].winding;
    tree.forTrianglesAt(from, [&](Index triangle) {
      const Index place = own_->found(triangle);
      if (place == GridSurface::kNone || !own_->at(place).isCut()) {
        if (winding != 0) passThrough(triangle, winding);
        return;
      }
      const GridSurface::Triangle& t = own_->at(place);
      const int k =
          static_cast<int>(std::find(t.vertices.begin(), t.vertices.end(), from) - t.vertices.begin());
      for (const int to : {(k + 1) % 3, (k + 2) % 3}) set(t.vertices[to], windingAlong(t, k, to));
    });
  }
}

/// Adds a triangle that is not cut, and goes on to its other vertices.
void Enclosure::passThrough(Index triangle, int winding) {
  if (added_in_[triangle] == query_) return;
  added_in_[triangle] = query_;
  const SurfaceTree::Triangle& v = own_->tree().triangles()[triangle];
  const Vec3d a = own_->vertex(v[0]), b = own_->vertex(v[1]), c = own_->vertex(v[2]);
  const Vec3d outwards = cross(b - a, c - a);
  // Where all corners lie on a line, the other surface crosses edges and does not meet the triangle.
  if (outwards == Vec3d{}) return;
  add(a, b, c, winding, outwards);
  for (const Index to : v) set(to, winding);
}

/// Returns the winding number at corner `to` from that at corner `from`.
int Enclosure::windingAlong(const GridSurface::Triangle& t, int from, int to) const {
  const bool forward = (from + 1) % 3 == to;
  int winding = vertices_[t.vertices[from]].winding;
  for (Index i = t.first_crossing; i != GridSurface::kNone; i = own_->crossings()[i].next) {
    const Crossing& crossing = own_->crossings()[i];
    if (crossing.edge == (forward ? from : to)) winding += forward ? crossing.change : -crossing.change;
  }
  return winding;
}

/// Adds what is enclosed of a triangle that is cut. The border of this consists of segments, and of parts of
/// the edges: with one corner in common each of them makes a triangle, to be added or taken away.
void Enclosure::addCut(const GridSurface::Triangle& t) {
  const Vec3d& apex = own_->segments()[t.first_segment].from;
  const auto addBorder = [&](const Vec3d& from, const Vec3d& to, int winding) {
    if (winding != 0) add(apex, from, to, winding, t.normal);
  };
  for (Index i = t.first_segment; i != GridSurface::kNone; i = own_->segments()[i].next)
    addBorder(own_->segments()[i].from, own_->segments()[i].to, 1);
  for (int edge = 0; edge < 3; ++edge) {
    along_.clear();
    for (Index i = t.first_crossing; i != GridSurface::kNone; i = own_->crossings()[i].next) {
      if (own_->crossings()[i].edge == edge) along_.push_back(&own_->crossings()[i]);
    }
    std::sort(along_.begin(), along_.end(),
              [](const Crossing* a, const Crossing* b) { return a->part < b->part; });
    const int next = (edge + 1) % 3;
    int winding = vertices_[t.vertices[edge]].winding;
    const Vec3d* from = &t.corners[edge];
    for (const Crossing* crossing : along_) {
      addBorder(*from, crossing->at, winding);
      winding += crossing->change;
      from = &crossing->at;
    }
    assert(winding == vertices_[t.vertices[next]].winding);
    addBorder(*from, t.corners[next], winding);
  }
}

}  // namespace

EnclosedSums sumEnclosed(GridSurface& own, GridSurface& other, const Vec3d& origin, bool volume_only) {
  static thread_local Enclosure enclosure;
  return enclosure.sum(own, other, origin, volume_only);
}

}  // namespace innersphere
