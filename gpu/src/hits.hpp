// Overlapping pairs of spheres.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace innersphere {

/// A sphere with more partners than that has them summed in so many shares.
constexpr unsigned kContactShares = 256;

/// An overlapping pair of spheres of one query of a batch.
struct Hit {
  std::uint32_t query;
  std::uint32_t a;
  std::uint32_t b;
};

/// Hits in no particular order; `count` of `items` are valid, the rest is room for the next run.
struct Hits {
  std::vector<Hit> items;
  std::size_t count = 0;
};

}  // namespace innersphere
