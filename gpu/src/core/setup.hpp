// Holds one query of a batch, checked and brought into the form that the traversal reads. It is plain data,
// which is copied to the device.
#pragma once

#include <cstdint>

#include "common/mat3.hpp"
#include "core/fixed_sum.hpp"
#include "core/grid_view.hpp"

namespace innersphere::core {

/// Holds the transforms that take spheres of both bodies into double precision and world axes. A body's own
/// frame is scaled and rotated, not translated, into the axes of the world.
struct Frame {
  Mat3<double> matrix_a, matrix_b;  ///< Scale times rotation.
  double scale_a, scale_b;
  double margin_a, margin_b;  ///< What every radius grows by [m].
  Vec3d offset;               ///< From the origin of A to that of B, in axes of the world [m].
};

/// Says how spheres of one body are looked up in the other's grid, in that grid's lengths. The transform is
/// in double, so that a position is rounded to single precision only once it is relative to the centre of the
/// grid; the lookup then makes everything larger by `tolerance`, which is more than that rounding. It only
/// picks candidates.
struct Search {
  Mat3<double> matrix;  ///< From the frame of the query sphere's packing.
  Vec3d offset;         ///< From the grid's centre to the origin of that frame.
  float ratio;          ///< The scale of the query spheres over that of the grid.
  float margin;         ///< The margin of the query spheres.
  float grid_margin;    ///< The margin of the spheres in the grid.
  float tolerance;
};

/// Holds the units of the sums, for each kind of quantity.
struct Units {
  Unit volume, moment, torque, area, energy;
};

/// Holds all that a query has beside its grids.
struct PairSetup {
  Frame frame;
  Search searches[2];  ///< Of A's spheres in B's grid, and of B's in A's.
  Units units;
  double most_volume;         ///< The volume that the smaller body has [m^3]; infinity: not known.
  std::uint32_t clusters[2];  ///< Those of each body that traverse the other's grid: 0 if they are apart.
};

/// Holds all that the traversal of one query reads.
struct Setup : PairSetup {
  GridView a, b;
};

}  // namespace innersphere::core
