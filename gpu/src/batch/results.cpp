#include "batch/results.hpp"

#include "core/fixed_sum.hpp"

namespace innersphere {

namespace {

Vec3d toVec(const double* terms) {
  return {terms[0], terms[1], terms[2]};
}

}  // namespace

core::Totals toTotals(const core::Sums& sums, const core::Units& units) {
  core::Totals totals;
  totals.pairs = sums.pairs;
  for (int i = 0; i < core::kTerms; ++i) totals.terms[i] = core::toDouble(sums.terms[i], unitOf(units, i));
  return totals;
}

Overlap toOverlap(const core::Totals& totals, const core::PairSetup& setup) {
  Overlap overlap;
  overlap.pair_count = totals.pairs;
  const double lenses = totals.terms[core::kVolume];
  overlap.volume = core::sharedVolume(lenses, setup);
  if (lenses > 0) {
    overlap.centroid = toVec(totals.terms + core::kMoment);
    for (double& c : overlap.centroid) c /= lenses;
  }
  overlap.force = toVec(totals.terms + core::kForce);
  overlap.torque = toVec(totals.terms + core::kTorque);
  overlap.area = toVec(totals.terms + core::kArea);
  overlap.stiffness = totals.terms[core::kStiffness];
  overlap.energy = totals.terms[core::kEnergy];
  return overlap;
}

}  // namespace innersphere
