// A tree over the spheres of a packing, on a device: what the hash grid of the query is compared with. Nodes
// follow Karras, "Maximizing Parallelism in the Construction of BVHs, Octrees, and k-d Trees", HPG 2012.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/setup.hpp"
#include "innersphere/geometry.hpp"

namespace innersphere::benchmarks {

class SphereBvh {
 public:
  explicit SphereBvh(const std::vector<Sphere>& spheres);
  ~SphereBvh();

  /// Builds it anew, in the memory it has. Returns the time of the device [s].
  double build();
  std::size_t bytes() const;  ///< of nodes and sorted spheres

  struct Result {
    std::vector<double> volumes;  ///< of each pose [m^3]
    std::vector<unsigned long long> pairs;
    double kernel = 0;  ///< [s]
  };
  /// Overlaps of the spheres of `a` with these, a frame for each pose.
  Result overlap(const SphereBvh& a, const std::vector<core::Frame>& poses) const;

 private:
  struct Arrays;
  std::unique_ptr<Arrays> arrays_;
};

}  // namespace innersphere::benchmarks
