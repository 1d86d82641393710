// The sums of one query over its overlapping pairs.
#pragma once

#include <cstdint>

#include "core/fixed_sum.hpp"
#include "core/pair.hpp"
#include "core/setup.hpp"

namespace innersphere::core {

/// Places of the sums in Sums::terms. Want::volume needs the first kVolumeTerms of them.
enum Term {
  kVolume = 0,
  kMoment = 1,
  kVolumeTerms = 4,
  kForce = 4,
  kTorque = 7,
  kArea = 10,
  kStiffness = 13,
  kEnergy = 14,
  kTerms = 15
};

struct Sums {
  unsigned long long pairs;
  FixedSum terms[kTerms];

  INNERSPHERE_HD void clear() {
    pairs = 0;
    for (int i = 0; i < kTerms; ++i) terms[i] = {0, 0};
  }

  INNERSPHERE_HD void add(const Sums& other) {
    pairs += other.pairs;
    for (int i = 0; i < kTerms; ++i) terms[i] = terms[i] + other.terms[i];
  }

  INNERSPHERE_HD void add(int term, double x, int shift) { terms[term] = terms[term] + toFixed(x, shift); }

  INNERSPHERE_HD void add(int term, const Vec3r& v, int shift) {
    add(term, v.x, shift);
    add(term + 1, v.y, shift);
    add(term + 2, v.z, shift);
  }

  /// Adds one overlapping pair; all terms with `wrench`, otherwise volume, moment and count.
  INNERSPHERE_HD void add(const Pair& pair, const Shifts& shifts, bool wrench) {
    const Contact contact = makeContact(pair);
    const double volume = contact.lens.volume;
    const double rim = contact.lens.rim_area;
    ++pairs;
    add(kVolume, volume, shifts.volume);
    add(kMoment, volume * lensCentroid(pair, contact), shifts.moment);
    if (!wrench) return;
    const Vec3r force = volume * contact.n;
    add(kForce, force, shifts.volume);
    add(kTorque, cross(pair.b, force),
        shifts.torque);  // the force is central, so any point of its line will do
    add(kArea, rim * contact.n, shifts.area);
    add(kStiffness, rim, shifts.area);
    add(kEnergy, lensEnergy(pair.ra, pair.rb, contact.distance, contact.depth), shifts.energy);
  }
};

}  // namespace innersphere::core
