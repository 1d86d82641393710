// Holds the spheres that the cells of a grid list as columns, so that a query sphere tests many of them with
// one instruction and without looking each of them up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/grid_view.hpp"

namespace innersphere {

/// Points to spheres as columns: an array for each coordinate.
struct SphereColumns {
  const float *x, *y, *z, *radius;

  SphereColumns from(std::size_t k) const { return {x + k, y + k, z + k, radius + k}; }
};

class ListedSpheres {
 public:
  /// Fills the columns. `centred` is what the places in the lists mean. Allocates only where it needs more
  /// memory than ever.
  void build(const Sphere* centred, const std::vector<std::uint32_t>& listed);

  /// Returns the columns, which are parallel to the lists.
  SphereColumns columns() const {
    const float* const first = memory_.get();
    return {first, first + capacity_, first + 2 * capacity_, first + 3 * capacity_};
  }

 private:
  std::unique_ptr<float[]> memory_;
  std::size_t capacity_ = 0;
};

}  // namespace innersphere
