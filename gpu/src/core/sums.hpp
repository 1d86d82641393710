// Forms the sums of one query over its overlapping pairs.
#pragma once

#include <cstdint>

#include "core/fixed_sum.hpp"
#include "core/pair.hpp"
#include "core/setup.hpp"

namespace innersphere::core {

/// Names the places of the sums. Want::volume needs the first kVolumeTerms of them.
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

INNERSPHERE_HD inline const Unit& unitOf(const Units& units, int term) {
  if (term == kVolume) return units.volume;
  if (term < kForce) return units.moment;
  if (term < kTorque) return units.volume;
  if (term < kArea) return units.torque;
  return term < kEnergy ? units.area : units.energy;
}

/// Holds what one pair adds to each sum.
struct Terms {
  double terms[kTerms];

  INNERSPHERE_HD void set(int term, const Vec3d& v) {
    terms[term] = v.x;
    terms[term + 1] = v.y;
    terms[term + 2] = v.z;
  }
};

/// Sets all terms but the energy with kWrench, otherwise the first kVolumeTerms.
template <bool kWrench>
INNERSPHERE_HD inline void setTerms(const Pair& pair, const Contact& contact, Terms& terms) {
  const double volume = contact.lens.volume, rim = contact.lens.rim_area;
  terms.terms[kVolume] = volume;
  terms.set(kMoment, lensMoment(pair, contact));
  if (!kWrench) return;
  const Vec3d force = volume * contact.n;
  terms.set(kForce, force);
  terms.set(kTorque, cross(pair.b, force));  // the force is central, so any point of its line will do
  terms.set(kArea, rim * contact.n);
  terms.terms[kStiffness] = rim;
}

/// Makes all terms with kWrench, otherwise the first kVolumeTerms.
template <bool kWrench>
INNERSPHERE_HD inline Terms makeTerms(const Pair& pair) {
  const Contact contact = makeContact(pair);
  Terms terms;
  setTerms<kWrench>(pair, contact, terms);
  if (kWrench) terms.terms[kEnergy] = lensEnergy(contact.balls);
  return terms;
}

/// Returns the volume that a sum of lenses stands for. Spheres of one body overlap each other: where bodies
/// lie upon each other their lenses sum up to more than there is.
INNERSPHERE_HD inline double sharedVolume(double lenses, const PairSetup& setup) {
  return lenses < setup.most_volume ? lenses : setup.most_volume;
}

/// Holds the sums in floating point.
struct Totals {
  double terms[kTerms];
  std::uint64_t pairs;
};

struct Sums {
  std::uint64_t pairs;
  FixedSum terms[kTerms];

  void clear() {
    pairs = 0;
    for (FixedSum& term : terms) term = {0, 0};
  }

  void add(const Sums& other) {
    pairs += other.pairs;
    for (int i = 0; i < kTerms; ++i) terms[i] = terms[i] + other.terms[i];
  }
};

}  // namespace innersphere::core
