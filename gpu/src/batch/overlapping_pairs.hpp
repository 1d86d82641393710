// Declares lists of overlapping pairs of spheres.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace innersphere {

/// A sphere with more partners than this has them summed in so many partial sums.
constexpr unsigned kPartialSums = 256;

/// Names an overlapping pair of spheres of one query of a batch.
struct OverlappingPair {
  std::uint32_t query;
  std::uint32_t a;
  std::uint32_t b;
};

/// Holds what a pair adds to the contacts of both of its spheres, laid out as a SphereContact is, with zero
/// in the place of the sphere.
struct alignas(64) ContactValues {
  static constexpr std::size_t kVolume = 1, kMoment = 2, kArea = 5, kCount = 8;
  double of[kCount];
};

/// Holds overlapping pairs in no particular order. The first `count` are valid, the rest is room for the next
/// run.
struct OverlappingPairs {
  std::vector<OverlappingPair> items;
  std::vector<ContactValues> values;  ///< The values of the items, where contacts are wanted.
  std::size_t count = 0;

  std::size_t room(bool with_values) const {
    return with_values ? std::min(items.size(), values.size()) : items.size();
  }
  void reserve(std::size_t found_pairs, bool with_values) {
    items.resize(std::max(items.size(), found_pairs));
    if (with_values) values.resize(std::max(values.size(), found_pairs));
  }
  void release() { *this = OverlappingPairs(); }
};

}  // namespace innersphere
