// Says where a body is in many poses, as arrays.
#pragma once

#include <cstddef>
#include <optional>

#include "innersphere/placement.hpp"

namespace innersphere {

/// Points to arrays of poses, of matrices or else of positions and quaternions. They lie in memory of the
/// host or, for a query that runs there, of a CUDA device.
struct Poses {
  /// The number of poses.
  std::size_t count = 0;
  /// count x 4 x 4 numbers, row-major: matrices that act on columns, [m] in the last column. Their upper left
  /// 3x3 part is a rotation to within 1e-4, and the last row is 0 0 0 1 to within 1e-6. Null: the other two.
  const double* matrices = nullptr;
  const double* positions = nullptr;    ///< count x 3 numbers [m].
  const double* quaternions = nullptr;  ///< count x 4 numbers: unit quaternions x y z w, to within 5e-5.
};

/// Returns where a pose brings a body, of poses in memory of the host. Returns nothing if the last row of its
/// matrix is not 0 0 0 1. All else that a pose may have wrong is found by the query, which names it.
std::optional<Placement> placementAt(const Poses& poses, std::size_t number);

}  // namespace innersphere
