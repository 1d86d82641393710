#include "shape/feelers.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/bullet_vectors.hpp"
#include "common/parallel.hpp"

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
/// Places that one thread looks at, one after the other.
constexpr std::size_t kBlock = 1024;

/// This is a place of the surface.
struct Place {
  btVector3 at;
  btVector3 normal;  ///< unit, out of the solid
  std::uint32_t triangle;
  btScalar gap;  ///< to the nearest sphere or ball [m]
};

btScalar sizeOf(const Surface& surface) {
  btVector3 min = toBullet(surface.vertices[0]), max = min;
  for (const auto& vertex : surface.vertices) {
    min.setMin(toBullet(vertex));
    max.setMax(toBullet(vertex));
  }
  return (max - min).length();
}

/// The middles of the parts of each triangle, none longer than `apart`, and the vertices.
std::vector<Place> placesOn(const Surface& surface, btScalar apart) {
  std::vector<Place> places;
  std::vector<Place> corners(surface.vertices.size(), Place{{0, 0, 0}, {0, 0, 0}, 0, BT_LARGE_FLOAT});
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    btVector3 v[3];
    for (int k = 0; k < 3; ++k) v[k] = toBullet(surface.vertices[surface.triangles[t][k]]);
    const btVector3 across = (v[1] - v[0]).cross(v[2] - v[0]);
    const btScalar longest = btMax(v[0].distance(v[1]), btMax(v[1].distance(v[2]), v[2].distance(v[0])));
    if (!(across.length2() > 0)) continue;
    for (int k = 0; k < 3; ++k) {
      Place& corner = corners[surface.triangles[t][k]];
      corner.at = v[k];
      corner.normal += across;
      corner.triangle = t;
    }
    const int parts = static_cast<int>(std::ceil(longest / apart));
    const auto add = [&](btScalar i, btScalar j) {
      const btVector3 at = v[0] + ((v[1] - v[0]) * i + (v[2] - v[0]) * j) / btScalar(parts);
      places.push_back({at, across.normalized(), t, BT_LARGE_FLOAT});
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

template <typename Job>
void forEachBlock(std::vector<Place>& places, const Job& job) {
  inParallel((places.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
    const std::size_t end = std::min(places.size(), (block + 1) * kBlock);
    for (std::size_t i = block * kBlock; i < end; ++i) job(places[i]);
  });
}

void closeGaps(const Sphere& ball, Place& place) {
  place.gap = btMin(place.gap, place.at.distance(centre(ball)) - btScalar(ball.radius));
}

/// The largest ball inside that touches a place.
Sphere ballAt(const Place& place, btScalar size, const SurfaceQueries& surface) {
  btScalar radius = size / 2;
  for (int i = 0; i < kShrinkings && radius > kSmallest * size; ++i) {
    const btVector3 middle = place.at - place.normal * radius;
    SurfaceQueries::Nearest nearest;
    surface.nearest(middle, BT_LARGE_FLOAT, nearest);
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

}  // namespace

Feelers placeFeelers(const Packing& packing, std::size_t count, btScalar inset,
                     const SurfaceQueries& surface) {
  Feelers feelers;
  feelers.inset = inset;
  const btScalar size = sizeOf(packing.surface);
  if (!(inset > kNear * size)) return feelers;
  std::vector<Place> places = placesOn(packing.surface, kApart * size);
  forEachBlock(places, [&](Place& place) {
    for (std::size_t i = 0; i < count; ++i) closeGaps(packing.spheres[i], place);
  });
  const auto smaller = [](const Place& a, const Place& b) { return a.gap < b.gap; };
  auto furthest = std::max_element(places.begin(), places.end(), smaller);
  while (furthest->gap > kNear * size) {
    const Sphere ball = ballAt(*furthest, size, surface);
    feelers.balls.push_back(ball);
    feelers.triangles.push_back(furthest->triangle);
    // Rounding must not have it chosen again.
    furthest->gap = 0;
    forEachBlock(places, [&](Place& place) { closeGaps(ball, place); });
    furthest = std::max_element(places.begin(), places.end(), smaller);
  }
  feelers.inset = furthest->gap;
  return feelers;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere
