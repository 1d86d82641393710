// The hash grid as the paper has it, to compare with: DJB2, a sphere in each of up to eight cells, buckets
// of 24.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "innersphere/geometry.hpp"
#include "innersphere/placement.hpp"

namespace innersphere::benchmarks {

/// Weller, Frese, Zachmann 2013, with the level rule that keeps the eight cells (2 r <= cell < 4 r).
class PaperGrid {
 public:
  static constexpr std::size_t kBucket = 24;

  struct Bucket {
    std::uint32_t count = 0;
    std::uint32_t spheres[kBucket];
  };

  explicit PaperGrid(const std::vector<Sphere>& spheres);

  const std::vector<Sphere>& spheres() const { return spheres_; }
  const std::vector<Bucket>& buckets() const { return buckets_; }
  int finest() const { return finest_; }  ///< level, as exponent of its cells
  int coarsest() const { return coarsest_; }

  /// Spheres times cells that found their bucket full: contacts that may be missed.
  std::size_t overflows() const { return overflows_; }

  struct Result {
    std::size_t pairs = 0;
    double volume = 0;
  };
  /// The spheres of `query spheres` (placed relative to the grid) against those of the grid that are at least
  /// as large (or, if `strictly`, larger).
  Result traverse(const std::vector<Sphere>& query_spheres, const Placement& placement, bool strictly) const;

 private:
  const Bucket& bucket(int level, const std::array<int, 3>& cell) const;

  const std::vector<Sphere>& spheres_;
  std::vector<Bucket> buckets_;
  int finest_ = 0, coarsest_ = 0;
  std::size_t overflows_ = 0;
};

}  // namespace innersphere::benchmarks
