// One query of a batch, checked and brought into the form that the walk reads. Plain data: it is copied to
// the device.
#pragma once

#include <cstdint>

#include "core/fixed_sum.hpp"
#include "core/grid_view.hpp"
#include "core/mat3.hpp"

namespace innersphere::core {

/// What takes two spheres into double precision and world axes. A body's own frame is scaled and rotated, not
/// translated, into the axes of the world.
struct Frame {
  Mat3<double> matrix_a, matrix_b;  ///< scale times rotation
  double scale_a, scale_b;
  double margin_a, margin_b;  ///< every radius grows by it [m]
  Vec3d offset;               ///< from the origin of A to that of B, axes of the world [m]
};

/// A body as a query sees it.
struct Body {
  GridView grid;
  std::uint32_t clusters;  ///< that walk through the other's grid: none if the bodies are apart
};

/// How spheres of one body are looked up in the other's grid, in that grid's lengths. The transform is in
/// double, so that a position is rounded to single precision only once it is relative to the centre of the
/// grid; the lookup then makes everything larger by `tolerance`, which is more than that rounding. It only
/// picks candidates.
struct Search {
  Mat3<double> matrix;  ///< from the packing's frame of the sphere that walks
  Vec3d offset;         ///< from the grid's centre to the origin of that frame
  float ratio;          ///< of the scales
  float margin;         ///< of the spheres that walk
  float grid_margin;    ///< of those in the grid
  float tolerance;
};

/// Of the sums, for each kind of quantity.
struct Units {
  Unit volume, moment, torque, area, energy;
};

struct Setup {
  Body a, b;
  Frame frame;
  Search a_in_b, b_in_a;
  Units units;
};

}  // namespace innersphere::core
