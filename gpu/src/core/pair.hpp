// Two spheres, one of each body: do they overlap, and what do they contribute?
#pragma once

#include <cmath>
#include <cstdint>

#include "core/lens.hpp"
#include "core/setup.hpp"

namespace innersphere::core {

/// A pair in double precision and world axes.
struct Pair {
  Vec3r a, b;     ///< centres, each relative to the origin of its own body
  Vec3r v;        ///< from the centre of a to that of b
  double ra, rb;  ///< radii, grown by the margin
  double distance2;
};

/// From places in the two grids. Everything in it is symmetric under exchange of the bodies, to the last bit:
/// v changes sign, the rest changes places.
INNERSPHERE_HD inline Pair makePair(const Setup& setup, std::uint32_t ia, std::uint32_t ib) {
  const Sphere a = setup.a.grid.spheres[ia];
  const Sphere b = setup.b.grid.spheres[ib];
  Pair pair;
  pair.a = setup.a.matrix * Vec3r{a.x, a.y, a.z};
  pair.b = setup.b.matrix * Vec3r{b.x, b.y, b.z};
  pair.v = setup.offset + (pair.b - pair.a);
  pair.ra = setup.a.scale * a.radius + setup.a.margin;
  pair.rb = setup.b.scale * b.radius + setup.b.margin;
  pair.distance2 = dot(pair.v, pair.v);
  return pair;
}

/// Touching from outside is not an overlap: its volume is zero.
INNERSPHERE_HD inline bool overlaps(const Pair& pair) {
  const double sum = pair.ra + pair.rb;
  return pair.distance2 < sum * sum;
}

/// Who of the two finds the pair: the smaller sphere walks through the other's grid; of equals, that of A.
INNERSPHERE_HD inline bool walksToPartner(const Pair& pair, bool from_a) {
  return from_a ? pair.rb >= pair.ra : pair.ra > pair.rb;
}

/// An overlapping pair's lens, with the unit vector from a to b. Concentric spheres have no direction: n is
/// zero, so they push nowhere.
struct Contact {
  Lens<double> lens;
  double distance;
  double depth;
  Vec3r n;
};

INNERSPHERE_HD inline Contact makeContact(const Pair& pair) {
  constexpr double kSmallest = 1e-300;  // below it the square of the distance has lost its digits
  using std::sqrt;
  const double sum = pair.ra + pair.rb;
  const bool apart = pair.distance2 > kSmallest;
  Contact contact;
  contact.distance = apart ? sqrt(pair.distance2) : 0.0;
  contact.depth = (sum * sum - pair.distance2) / (sum + contact.distance);
  contact.n = (apart ? 1 / contact.distance : 0.0) * pair.v;
  contact.lens = lens(pair.ra, pair.rb, contact.distance, contact.depth);
  return contact;
}

/// Centroid of the lens, relative to the origin of A.
INNERSPHERE_HD inline Vec3r lensCentroid(const Pair& pair, const Contact& contact) {
  return pair.a + contact.lens.fraction * pair.v;
}

}  // namespace innersphere::core
