// What a query must return, by testing every sphere against every other in long double. Shares no code with
// the query.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "innersphere/query.hpp"

namespace innersphere::test {

using Real = long double;
using Vec3l = std::array<Real, 3>;

struct OracleContact {
  Real volume = 0;
  Vec3l moment{};
  Vec3l area{};
  Real area_size = 0;  ///< of the terms, for tolerances
};

struct Oracle {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;  ///< that overlap, sorted
  std::vector<std::pair<std::uint32_t, std::uint32_t>>
      unclear;  ///< that touch to within rounding of the input
  Real volume = 0, stiffness = 0, energy = 0;
  Real energy_rounding = 0;  ///< what the textbook formula loses where spheres hardly touch
  Vec3l moment{}, force{}, torque{}, area{};
  Real moment_size = 0, torque_size = 0;              ///< sums of the lengths of the terms, for tolerances
  std::vector<OracleContact> contacts_a, contacts_b;  ///< of every sphere
};

Oracle bruteForce(const PairQuery& query, Estimator estimator);

/// Empty if the pairs are the oracle's (unclear ones may be in or out), else the first difference.
std::string differenceInPairs(const Oracle& oracle, const SpherePair* pairs, std::size_t count);

/// Empty if all sums are the oracle's to within `tolerance` of the sum of the sizes of their terms.
std::string differenceInSums(const Oracle& oracle, const Overlap& overlap, double tolerance = 1e-9);

}  // namespace innersphere::test
