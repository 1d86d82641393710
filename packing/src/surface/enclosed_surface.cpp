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
  return z > std::max(x, y) ? 2 : y > x ? 1 : 0;
}

/// Brings winding numbers in the other solid from triangle to triangle, as far as these are in it.
class Enclosure {
 public:
  EnclosedSums sum(GridSurface& own, GridSurface& other, const Vec3d& origin, bool volume_only);

 private:
  /// Says to a triangle what the winding number is in one of its corners.
  struct Step {
    Index corner;  ///< 4 t + k for corner k of triangle t
    int winding;
  };

  void addAll();
  void startAt(Index triangle);
  void flood();
  void pass(Index edge, int winding, bool is_inside);
  void passThrough(const Step& step);
  void passCut(const Step& step);
  void addCut(const GridSurface::Triangle& t, const int (&windings)[3]);
  void add(const Vec3d& place, const PlanePart& part, const Vec3d& normal);
  int windingAt(Index vertex) const { return other_->windingAt(own_->vertex(vertex)); }

  GridSurface* own_ = nullptr;
  GridSurface* other_ = nullptr;
  Vec3d origin_;
  bool volume_only_;
  EnclosedSums sums_;
  Index passed_ = 0, cut_ = 1;            ///< marks of this query: two numbers that no one had before
  std::vector<Index> marks_;              ///< of triangles: cut_, until the flood comes to it: passed_
  std::vector<Step> to_cut_, to_others_;  ///< to all triangles to which the flood came
  std::size_t cut_count_ = 0, others_count_ = 0;
  std::vector<char> has_cut_;  ///< of the parts of the surface
};

EnclosedSums Enclosure::sum(GridSurface& own, GridSurface& other, const Vec3d& origin, bool volume_only) {
  own_ = &own;
  other_ = &other;
  origin_ = origin;
  volume_only_ = volume_only;
  sums_ = {};
  passed_ += 2, cut_ += 2;
  if (passed_ == 0) {
    marks_.clear();
    passed_ = 2, cut_ = 3;
  }
  const std::size_t count = own.tree().triangles().size();
  if (marks_.size() < count) {
    marks_.resize(count);
    to_cut_.resize(count);
    to_others_.resize(count);
  }
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
  has_cut_.assign(tree.partCount(), 0);
  for (const Segment& segment : own_->segments()) {
    marks_[segment.own] = cut_;
    has_cut_[tree.partOf(segment.own)] = 1;
  }
  // Triangles that are cut are next to all that is in the other solid, but for whole parts.
  for (const Segment& segment : own_->segments()) startAt(segment.own);
  for (Index part = 0; part < tree.partCount(); ++part) {
    if (has_cut_[part] == 0) startAt(tree.triangleOfPart(part));
  }
}

void Enclosure::startAt(Index triangle) {
  if (marks_[triangle] == passed_) return;
  const int winding = windingAt(own_->tree().triangles()[triangle][0]);
  pass(4 * triangle, winding, winding != 0);
  flood();
}

void Enclosure::flood() {
  std::size_t cut = 0, others = 0;
  while (cut < cut_count_ || others < others_count_) {
    while (cut < cut_count_) passCut(to_cut_[cut++]);
    while (others < others_count_) passThrough(to_others_[others++]);
  }
  cut_count_ = others_count_ = 0;
}

/// Goes on to the triangle of an edge, at the beginning of which the winding number is known. One that is not
/// cut is of use only if it is inside.
void Enclosure::pass(Index edge, int winding, bool is_inside) {
  Index& mark = marks_[edge / 4];
  if (mark == passed_) return;
  if (mark == cut_) {
    to_cut_[cut_count_++] = {edge, winding};
  } else if (is_inside) {
    to_others_[others_count_++] = {edge, winding};
  } else {
    return;
  }
  mark = passed_;
}

/// Adds a triangle that is not cut, and goes on from it.
void Enclosure::passThrough(const Step& step) {
  const Index triangle = step.corner / 4;
  const SurfaceTree::Triangle& v = own_->tree().triangles()[triangle];
  const std::array<Index, 4>& twins = own_->tree().twins(triangle);
  CornerPlaces corners;
  own_->placeCorners(v, corners);
  const Vec3d a = corners.corner(0), b = corners.corner(1), c = corners.corner(2);
  const Vec3d outwards = cross(b - a, c - a);
  if (outwards == Vec3d{}) {
    // All corners lie on a line. The other surface may cross edges, but does not meet the triangle.
    const int windings[] = {windingAt(v[0]), windingAt(v[1]), windingAt(v[2])};
    for (int k = 0; k < 3; ++k) {
      const int next = Corners::next(k);
      pass(twins[k], windings[next], (windings[k] | windings[next]) != 0);
    }
    return;
  }
  const auto area = static_cast<double>(step.winding);
  add(a, {area, std::abs(area), area * ((a - origin_) + (b - origin_) + (c - origin_))}, outwards);
  for (int k = 0; k < 3; ++k) pass(twins[k], step.winding, true);
}

/// Adds what is enclosed of a triangle that is cut, and goes on from it.
void Enclosure::passCut(const Step& step) {
  const GridSurface::Triangle& t = own_->at(own_->find(step.corner / 4));
  const std::array<Index, 4>& twins = own_->tree().twins(t.index);
  const int first = static_cast<int>(step.corner % 4), next = Corners::next(first),
            last = Corners::next(next);
  int windings[3];
  windings[first] = step.winding;
  windings[next] = step.winding + t.changes[first];
  windings[last] = step.winding - t.changes[last];
  for (int k = 0; k < 3; ++k) {
    const int end = Corners::next(k);
    pass(twins[k], windings[end], (windings[k] | windings[end]) != 0);
  }
  addCut(t, windings);
}

/// Adds what is enclosed of a triangle that is cut. The border of this consists of segments, and of parts of
/// the edges: with one corner in common each of them makes a triangle, to be added or taken away. All lie in
/// one plane, so that two components of places are enough.
void Enclosure::addCut(const GridSurface::Triangle& t, const int (&windings)[3]) {
  const std::vector<Crossing>& crossings = own_->crossings();
  const Segment& first = own_->segments()[t.first_segment];
  const Vec3d& apex = first.from;
  const int k = largestAxis(t.normal), i = Corners::next(k), j = Corners::previous(k);
  if (t.normal[k] == 0) return;
  // From a place on each edge, winding numbers are those of its corners, but for what changes in between. Two
  // edges lie side by side, and the third beside one that counts for nothing.
  const double* places[4];
  std::size_t rows[4];
  for (int edge = 0; edge < 3; ++edge) {
    const Index crossing = t.first_crossings[edge];
    const double* const choice[] = {crossings[crossing].at.data(), t.places[0] + edge + 1};
    const std::size_t row[] = {1, GridTriangle::kRow};
    places[edge] = choice[crossing == 0];
    rows[edge] = row[crossing == 0];
  }
  places[3] = places[0], rows[3] = rows[0];
  const auto w = [&](int corner) { return static_cast<double>(windings[corner]); };
  const TwoDoubles at_from[2] = {{w(0), w(1)}, {w(2), 0}}, at_to[2] = {{w(1), w(2)}, {w(0), 0}};
  TwoDoubles areas{}, magnitudes{}, middles_i{}, middles_j{};
  for (const int half : {0, 1}) {
    const int edge = 2 * half;
    const auto at = [&](int axis) {
      return TwoDoubles{places[edge][rows[edge] * axis], places[edge + 1][rows[edge + 1] * axis]} -
             apex[axis];
    };
    const TwoDoubles from_i = twoAt(t.places[i] + edge) - apex[i],
                     from_j = twoAt(t.places[j] + edge) - apex[j],
                     to_i = twoAt(t.places[i] + 1 - half) - apex[i],
                     to_j = twoAt(t.places[j] + 1 - half) - apex[j], at_i = at(i), at_j = at(j);
    const TwoDoubles before = at_from[half] * (from_i * at_j - from_j * at_i),
                     after = at_to[half] * (at_i * to_j - at_j * to_i);
    areas += before + after;
    magnitudes += (before < 0 ? -before : before) + (after < 0 ? -after : after);
    middles_i += before * (from_i + at_i) + after * (at_i + to_i);
    middles_j += before * (from_j + at_j) + after * (at_j + to_j);
  }
  double area = areas[0] + areas[1], magnitude = magnitudes[0] + magnitudes[1],
         middle_i = middles_i[0] + middles_i[1], middle_j = middles_j[0] + middles_j[1];
  const auto addBorder = [&](const Vec3d& from, const Vec3d& to, int change) {
    const double ui = from[i] - apex[i], uj = from[j] - apex[j], vi = to[i] - apex[i], vj = to[j] - apex[j];
    const double part = change * (ui * vj - uj * vi);
    area += part;
    magnitude += std::abs(part);
    middle_i += part * (ui + vi);
    middle_j += part * (uj + vj);
  };
  for (Index s = first.next; s != GridSurface::kNone; s = own_->segments()[s].next)
    addBorder(own_->segments()[s].from, own_->segments()[s].to, 1);
  for (const Index last : t.first_crossings) {
    for (Index c = crossings[last].next; c != 0; c = crossings[c].next)
      addBorder(crossings[c].at, crossings[last].at, crossings[c].change);
  }
  const double unit = 1 / t.normal[k];
  PlanePart sum{unit * area, std::abs(unit) * magnitude, {}};
  sum.middle[i] = unit * middle_i;
  sum.middle[j] = unit * middle_j;
  sum.middle[k] = -unit * (t.normal[i] * sum.middle[i] + t.normal[j] * sum.middle[j]);
  sum.middle = sum.middle + 3 * sum.area * (apex - origin_);
  add(apex, sum, t.normal);
}

}  // namespace

EnclosedSums sumEnclosed(GridSurface& own, GridSurface& other, const Vec3d& origin, bool volume_only) {
  static thread_local Enclosure enclosure;
  return here(enclosure).sum(own, other, origin, volume_only);
}

}  // namespace innersphere
