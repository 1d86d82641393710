#include "shape/feelers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "common/bullet_vectors.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// In sizes of the solid: nearer spheres feel the surface well enough.
constexpr btScalar kNear = btScalar(0.01);
/// In sizes of the solid: how far places on a triangle are apart.
constexpr btScalar kApart = btScalar(0.02);
/// In sizes of the solid: no ball is smaller. In a corner it reaches out a little.
constexpr btScalar kSmallest = btScalar(1e-3);
/// A ball shrinks at most so often, until no more than this part of it is outside.
constexpr int kShrinkings = 30;
constexpr btScalar kShrinks = btScalar(1e-3);
/// In sizes of the solid: places this near to each other are looked at together.
constexpr btScalar kCell = btScalar(0.05);

/// This is a place of the surface.
struct Place {
  btVector3 at;
  btVector3 normal;  ///< unit, out of the solid
  std::uint32_t triangle;
  btScalar gap = BT_LARGE_FLOAT;   ///< to the nearest sphere or ball [m]
  btScalar open = BT_LARGE_FLOAT;  ///< the same; 0 if no ball is to touch it
  std::array<int, 3> cell{};       ///< of a grid
};

/// The middles of the parts of each triangle, none longer than `apart`, and the vertices.
std::vector<Place> placesOn(const Surface& surface, const SmoothNormals& normals, btScalar apart) {
  std::vector<Place> places;
  std::vector<Place> corners(surface.vertices.size(), Place{{0, 0, 0}, {0, 0, 0}, 0});
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    btVector3 v[3];
    for (int k = 0; k < 3; ++k) v[k] = toBullet(surface.vertices[surface.triangles[t][k]]);
    const btVector3 across = (v[1] - v[0]).cross(v[2] - v[0]);
    const btScalar longest = btMax(v[0].distance(v[1]), btMax(v[1].distance(v[2]), v[2].distance(v[0])));
    if (normals.face(t).isZero()) continue;
    for (int k = 0; k < 3; ++k) {
      Place& corner = corners[surface.triangles[t][k]];
      corner.at = v[k];
      corner.normal += across;
      corner.triangle = t;
    }
    const int parts = static_cast<int>(std::ceil(longest / apart));
    const auto add = [&](btScalar i, btScalar j) {
      const btVector3 at = v[0] + ((v[1] - v[0]) * i + (v[2] - v[0]) * j) / btScalar(parts);
      places.push_back({at, normals.face(t), t});
    };
    for (int i = 0; i < parts; ++i) {
      for (int j = 0; i + j < parts; ++j) {
        add(i + btScalar(1) / 3, j + btScalar(1) / 3);
        if (i + j + 1 < parts) add(i + btScalar(2) / 3, j + btScalar(2) / 3);
      }
    }
  }
  for (Place& corner : corners) {
    if (!(corner.normal.length2() > 0)) continue;
    corner.normal.normalize();
    places.push_back(corner);
  }
  return places;
}

/// Holds places, those near each other together, and finds the one furthest from all balls.
class Gaps {
 public:
  Gaps(std::vector<Place> places, btScalar cell_size) : places_(std::move(places)) {
    for (Place& place : places_) {
      for (int k = 0; k < 3; ++k)
        place.cell[std::size_t(k)] = static_cast<int>(std::floor(place.at[k] / cell_size));
    }
    std::stable_sort(places_.begin(), places_.end(),
                     [](const Place& a, const Place& b) { return a.cell < b.cell; });
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const btVector3& at = places_[i].at;
      if (i == 0 || places_[i].cell != places_[i - 1].cell)
        cells_.push_back({i, i, at, at, BT_LARGE_FLOAT, BT_LARGE_FLOAT});
      Cell& cell = cells_.back();
      cell.end = i + 1;
      cell.min.setMin(at);
      cell.max.setMax(at);
    }
  }

  void add(const Sphere& ball) {
    const btVector3 middle = centre(ball);
    for (Cell& cell : cells_) {
      btVector3 beyond = cell.min - middle;
      beyond.setMax(middle - cell.max);
      beyond.setMax(btVector3(0, 0, 0));
      if (!(beyond.length() - btScalar(ball.radius) < cell.gap)) continue;
      cell.gap = -BT_LARGE_FLOAT;
      cell.open = 0;
      for (std::size_t i = cell.begin; i < cell.end; ++i) {
        Place& place = places_[i];
        place.gap = btMin(place.gap, place.at.distance(middle) - btScalar(ball.radius));
        place.open = btMin(place.open, place.gap);
        cell.gap = btMax(cell.gap, place.gap);
        cell.open = btMax(cell.open, place.open);
      }
    }
  }

  /// From now on the furthest is one of those for which this is true.
  template <typename Predicate>
  void keep(const Predicate& isKept) {
    for (Cell& cell : cells_) {
      cell.open = 0;
      for (std::size_t i = cell.begin; i < cell.end; ++i) {
        Place& place = places_[i];
        if (!isKept(place)) place.open = 0;
        cell.open = btMax(cell.open, place.open);
      }
    }
  }

  const Place& furthest() const {
    const auto smaller = [](const auto& a, const auto& b) { return a.open < b.open; };
    const Cell& cell = *std::max_element(cells_.begin(), cells_.end(), smaller);
    return *std::max_element(places_.begin() + std::ptrdiff_t(cell.begin),
                             places_.begin() + std::ptrdiff_t(cell.end), smaller);
  }

  /// The gap of all places [m].
  btScalar largest() const {
    btScalar gap = -BT_LARGE_FLOAT;
    for (const Cell& cell : cells_) gap = btMax(gap, cell.gap);
    return gap;
  }

 private:
  struct Cell {
    std::size_t begin, end;  ///< of places
    btVector3 min, max;
    btScalar gap, open;  ///< the largest [m]
  };
  std::vector<Place> places_;
  std::vector<Cell> cells_;
};

/// The largest ball inside that touches a place.
Sphere ballAt(const Place& place, btScalar size, const SurfaceQueries& surface) {
  btScalar radius = size / 2;
  for (int i = 0; i < kShrinkings && radius > kSmallest * size; ++i) {
    const btVector3 middle = place.at - place.normal * radius;
    SurfaceQueries::Nearest nearest;
    // The place itself is that near, but for rounding.
    if (!surface.nearest(middle, radius * (1 + kShrinks), nearest)) break;
    if (nearest.distance < -radius * (1 - kShrinks)) break;  // it is inside
    // The ball through the place and this point, with its middle below the place.
    const btVector3 to_place = place.at - (middle - nearest.normal * nearest.distance);
    const btScalar height = place.normal.dot(to_place);
    if (!(height > 0)) break;
    radius = to_place.length2() / (2 * height);
  }
  radius = btMax(radius, kSmallest * size);
  const std::array<float, 3> middle = toFloats(place.at - place.normal * radius);
  return {middle[0], middle[1], middle[2], static_cast<float>(radius)};
}

std::uint32_t nearestSphere(const Sphere& ball, const Packing& packing, std::size_t count) {
  const auto gap = [&](const Sphere& s) { return centre(s).distance(centre(ball)) - btScalar(s.radius); };
  const auto end = packing.spheres.begin() + std::ptrdiff_t(count);
  const auto nearest = std::min_element(packing.spheres.begin(), end,
                                        [&](const Sphere& a, const Sphere& b) { return gap(a) < gap(b); });
  return static_cast<std::uint32_t>(nearest - packing.spheres.begin());
}

}  // namespace

Feelers placeFeelers(const Packing& packing, std::size_t count, btScalar inset, const SurfaceQueries& surface,
                     FeelerPlaces where) {
  Feelers feelers;
  feelers.inset = inset;
  const btScalar size = diagonalOf(packing.surface);
  if (!(inset > kNear * size)) return feelers;
  std::vector<Place> places = placesOn(packing.surface, surface.normals(), kApart * size);
  if (places.empty()) return feelers;  // no triangle has an area
  const auto isThin = [&](const Place& place, btScalar gap) {
    return surface.isThinner(2 * gap, place.at, place.normal);
  };
  // Most solids have no such places, and gaps take longer.
  if (where == FeelerPlaces::thin &&
      std::none_of(places.begin(), places.end(), [&](const Place& place) { return isThin(place, inset); }))
    return feelers;
  Gaps gaps(std::move(places), kCell * size);
  for (std::size_t i = 0; i < count; ++i) gaps.add(packing.spheres[i]);
  if (where == FeelerPlaces::thin)
    gaps.keep([&](const Place& place) { return place.gap > kNear * size && isThin(place, place.gap); });
  for (Place place = gaps.furthest(); place.open > kNear * size; place = gaps.furthest()) {
    const Sphere ball = ballAt(place, size, surface);
    // Where numbers are too large to be told apart, it would be chosen again and again.
    if (!(place.at.distance(centre(ball)) - btScalar(ball.radius) < place.gap)) break;
    feelers.balls.push_back(ball);
    feelers.largest_radius = btMax(feelers.largest_radius, btScalar(ball.radius));
    feelers.triangles.push_back(place.triangle);
    feelers.spheres.push_back(nearestSphere(ball, packing, count));
    gaps.add(ball);
  }
  if (where == FeelerPlaces::all || !feelers.balls.empty()) feelers.inset = gaps.largest();
  return feelers;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
