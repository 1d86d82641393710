// Says of two spheres, one of each body, whether they overlap and what they contribute.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/lens.hpp"
#include "core/setup.hpp"

namespace innersphere::core {

/// Describes a pair in double precision and world axes.
struct Pair {
  Vec3d a, b;     ///< centres, each relative to the origin of its own body
  Vec3d v;        ///< from the centre of a to that of b
  double ra, rb;  ///< radii, grown by the margin
  double distance2;
};

/// Makes a pair of spheres. Everything in it is symmetric under exchange of the bodies, to the last bit: v
/// changes sign, the rest changes places.
INNERSPHERE_HD inline Pair makePair(const Frame& frame, const Sphere& a, const Sphere& b) {
  Pair pair;
  pair.a = frame.matrix_a * Vec3d{a.x, a.y, a.z};
  pair.b = frame.matrix_b * Vec3d{b.x, b.y, b.z};
  pair.v = frame.offset + (pair.b - pair.a);
  pair.ra = frame.scale_a * a.radius + frame.margin_a;
  pair.rb = frame.scale_b * b.radius + frame.margin_b;
  pair.distance2 = dot(pair.v, pair.v);
  return pair;
}

/// Returns true if the spheres overlap. Touching from outside is not an overlap: its volume is zero.
INNERSPHERE_HD inline bool overlaps(const Pair& pair) {
  const double sum = pair.ra + pair.rb;
  return pair.distance2 < sum * sum;
}

/// Returns true if the sphere of the given side is the one of the two that finds the pair: the smaller sphere
/// traverses the other's grid; of equals, that of A.
INNERSPHERE_HD inline bool searchesPartner(const Pair& pair, bool from_a) {
  const bool a_searches = pair.rb >= pair.ra;
  return a_searches == from_a;
}

/// Returns true if a candidate of a cluster overlaps and is this side's to report.
INNERSPHERE_HD inline bool isReported(const Pair& pair, bool from_a) {
  const bool searches = searchesPartner(pair, from_a);
  return overlaps(pair) ? searches : false;
}

/// Holds an overlapping pair's lens, with the unit vector from a to b. Concentric spheres have no direction:
/// n is zero, so they push nowhere.
struct Contact {
  Balls balls;
  Lens lens;
  Vec3d n;
};

INNERSPHERE_HD inline Contact makeContact(const Pair& pair) {
  constexpr double kSmallest = 1e-300;  // below it the square of the distance has lost its digits
  using std::sqrt;
  const double sum = pair.ra + pair.rb;
  const bool apart = pair.distance2 > kSmallest;
  const double d = sqrt(apart ? pair.distance2 : kSmallest);
  // One division for all three: 1 / d, 1 / sum and 1 / (sum + d).
  const double reach = sum + d;
  const double inverse = 1 / (d * sum * reach);
  Contact contact;
  Balls& balls = contact.balls;
  balls.ra = pair.ra;
  balls.rb = pair.rb;
  balls.d = apart ? d : 0.0;
  balls.s = (sum * sum - pair.distance2) * (d * sum * inverse);
  balls.inverse_d = sum * reach * inverse;
  balls.inverse_sum = d * reach * inverse;
  contact.n = (apart ? balls.inverse_d : 0.0) * pair.v;
  contact.lens = lens(balls);
  return contact;
}

/// Returns volume times centroid of the lens, relative to the origin of A.
INNERSPHERE_HD inline Vec3d lensMoment(const Pair& pair, const Contact& contact) {
  return contact.lens.volume * pair.a + contact.lens.moment * pair.v;
}

}  // namespace innersphere::core
