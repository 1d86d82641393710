#include "surface/enclosed_surface.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

namespace innersphere {

namespace {

using Index = GridSurface::Index;

/// Holds sums over a part of a plane, times how often the other solid encloses it, all relative to the length
/// of the normal.
struct PlanePart {
  double area = 0;       ///< twice
  double magnitude = 0;  ///< the sum of absolute values in `area`
  Vec3d middle{};        ///< six times the integral of the places
};

/// Returns the axis along which a vector reaches farthest.
int largestAxis(const Vec3d& v) {
  const double x = std::abs(v.x), y = std::abs(v.y), z = std::abs(v.z);
  return x > y ? (x > z ? 0 : 2) : (y > z ? 1 : 2);
}

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
  void passCut(const GridSurface::Triangle& t, Index from);
  void addCut(const GridSurface::Triangle& t);
  void add(const Vec3d& place, const PlanePart& part, const Vec3d& normal);

  GridSurface* own_ = nullptr;
  GridSurface* other_ = nullptr;
  Vec3d origin_;
  bool volume_only_;
  EnclosedSums sums_;
  Index query_ = 0;
  std::vector<Vertex> vertices_;
  std::vector<Index> passed_in_;  ///< the query in which the flood came to a triangle
  std::vector<Index> open_;       ///< vertices from which to go on
  std::vector<char> is_cut_;      ///< of the parts of the surface
};

EnclosedSums Enclosure::sum(GridSurface& own, GridSurface& other, const Vec3d& origin, bool volume_only) {
  own_ = &own;
  other_ = &other;
  origin_ = origin;
  volume_only_ = volume_only;
  sums_ = {};
  if (++query_ == 0) {
    vertices_.clear();
    passed_in_.clear();
    query_ = 1;
  }
  vertices_.resize(std::max(vertices_.size(), own.tree().vertices().size()));
  passed_in_.resize(std::max(passed_in_.size(), own.tree().triangles().size()));
  addAll();
  return sums_;
}

/// Adds a part of a plane through a place.
void Enclosure::add(const Vec3d& place, const PlanePart& part, const Vec3d& normal) {
  const Vec3d from = place - origin_;
  const double height = dot(from, normal);
  sums_.volume += part.area * height;
  sums_.magnitude += part.magnitude * (std::abs(from.x * normal.x) + std::abs(from.y * normal.y) +
                                       std::abs(from.z * normal.z));
  sums_.moment = sums_.moment + height * part.middle;
  if (volume_only_) return;
  sums_.area = sums_.area + part.area * normal;
  sums_.turning = sums_.turning + cross(part.middle, normal);
  sums_.wetted += part.area * norm(normal);
}

void Enclosure::addAll() {
  const SurfaceTree& tree = own_->tree();
  is_cut_.assign(tree.partCount(), 0);
  // Vertices of triangles that are cut are next to all that is in the other solid, but for whole parts.
  for (Index i = 0; i < own_->foundCount(); ++i) {
    const GridSurface::Triangle& t = own_->at(i);
    if (!t.isCut()) continue;
    is_cut_[tree.partOf(t.vertices[0])] = 1;
    startAt(t.vertices[0]);
  }
  for (Index part = 0; part < tree.partCount(); ++part) {
    if (is_cut_[part] == 0) startAt(tree.vertexOfPart(part));
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
      if (std::exchange(passed_in_[triangle], query_) == query_) return;
      const Index place = own_->found(triangle);
      if (place != GridSurface::kNone && own_->at(place).isCut()) {
        passCut(own_->at(place), from);
      } else if (winding != 0) {
        passThrough(triangle, winding);
      }
    });
  }
}

/// Adds a triangle that is not cut, and goes on to its other vertices.
void Enclosure::passThrough(Index triangle, int winding) {
  const SurfaceTree::Triangle& v = own_->tree().triangles()[triangle];
  const Vec3d a = own_->vertex(v[0]), b = own_->vertex(v[1]), c = own_->vertex(v[2]);
  const Vec3d outwards = cross(b - a, c - a);
  // Where all corners lie on a line, the other surface crosses edges and does not meet the triangle.
  if (outwards == Vec3d{}) return;
  const auto area = static_cast<double>(winding);
  add(a, {area, std::abs(area), area * ((a - origin_) + (b - origin_) + (c - origin_))}, outwards);
  for (const Index to : v) set(to, winding);
}

/// Goes on from one corner of a triangle that is cut to the others, and adds what is enclosed of it.
void Enclosure::passCut(const GridSurface::Triangle& t, Index from) {
  const int first = t.vertices[0] == from ? 0 : t.vertices[1] == from ? 1 : 2, next = Corners::next(first);
  int at_next = vertices_[from].winding, at_last = at_next;
  for (Index i = t.first_crossing; i != GridSurface::kNone; i = own_->crossings()[i].next) {
    const Crossing& crossing = own_->crossings()[i];
    if (crossing.edge == first) at_next += crossing.change;
    if (crossing.edge == Corners::next(next)) at_last -= crossing.change;
  }
  set(t.vertices[next], at_next);
  set(t.vertices[Corners::next(next)], at_last);
  addCut(t);
}

/// Adds what is enclosed of a triangle that is cut. The border of this consists of segments, and of parts of
/// the edges: with one corner in common each of them makes a triangle, to be added or taken away. All lie in
/// one plane, so that one component of their normals is enough.
void Enclosure::addCut(const GridSurface::Triangle& t) {
  const Segment& first = own_->segments()[t.first_segment];
  const Vec3d& apex = first.from;
  const int k = largestAxis(t.normal), i = Corners::next(k), j = Corners::previous(k);
  if (t.normal[k] == 0) return;
  const double unit = 1 / t.normal[k];
  PlanePart sum;
  const auto addBorder = [&](const Vec3d& from, const Vec3d& to, int winding) {
    if (winding == 0) return;
    const Vec3d u = from - apex, v = to - apex;
    const double part = unit * winding * (u[i] * v[j] - u[j] * v[i]);
    sum.area += part;
    sum.magnitude += std::abs(part);
    sum.middle = sum.middle + part * (u + v);
  };
  for (Index s = first.next; s != GridSurface::kNone; s = own_->segments()[s].next)
    addBorder(own_->segments()[s].from, own_->segments()[s].to, 1);
  // From a place on each edge, winding numbers are those of its corners, but for what changes in between.
  const Vec3d* places[3] = {};
  for (Index c = t.first_crossing; c != GridSurface::kNone; c = own_->crossings()[c].next) {
    const Crossing& crossing = own_->crossings()[c];
    const Vec3d*& place = places[crossing.edge];
    if (place == nullptr) {
      place = &crossing.at;
    } else {
      addBorder(crossing.at, *place, crossing.change);
    }
  }
  for (int edge = 0; edge < 3; ++edge) {
    const int next = Corners::next(edge);
    const int before = vertices_[t.vertices[edge]].winding, after = vertices_[t.vertices[next]].winding;
    const Vec3d* place = places[edge];
    if (place != nullptr) {
      addBorder(t.corner(edge), *place, before);
      addBorder(*place, t.corner(next), after);
    } else {
      addBorder(t.corner(edge), t.corner(next), before);
    }
  }
  sum.middle = sum.middle + 3 * sum.area * (apex - origin_);
  add(apex, sum, t.normal);
}

}  // namespace

EnclosedSums sumEnclosed(GridSurface& own, GridSurface& other, const Vec3d& origin, bool volume_only) {
  static thread_local Enclosure enclosure;
  return enclosure.sum(own, other, origin, volume_only);
}

}  // namespace innersphere
