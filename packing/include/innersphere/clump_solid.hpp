// Comes as near to a solid as few spheres can that may overlap each other.
#pragma once

#include <cstddef>

#include "innersphere/covering.hpp"
#include "innersphere/progress.hpp"
#include "innersphere/solid.hpp"

namespace innersphere {

/// Says how clumpSolid() works.
struct ClumpOptions {
  /// The number of spheres, 1 to 1,000. There are fewer where no more bring the union nearer to the solid.
  std::size_t spheres = 64;
  /// How much volume of the spheres outside of the solid counts against volume of the solid that is in none,
  /// 1 to 100. With 1 the union is as near to the solid as can be; with more, spheres reach out less, and
  /// fill less.
  double outside_weight = 1;
  /// The number of threads. 0: all cores. The result does not depend on it.
  int threads = 0;
};

/// Returns spheres that may overlap each other and reach out of the solid, and of which the union differs
/// from it least: a clump, or multi-sphere particle. Spheres are placed one after the other, each where the
/// union wins most by it; then each in turn moves and changes its size as long as the union wins. Walls need
/// about as many spheres as there are balls of their thickness in them. Throws Error: bad_argument (options,
/// no volume), no_sphere_fits (a sheet), not_finite (the solid's distances), cancelled.
Covering clumpSolid(const Solid& solid, const ClumpOptions& options = {}, const Progress& progress = {});

/// Does the same for the solid that the packing's own surface bounds, as coverSurface() does. Throws Error
/// also: empty_input (the packing has no surface).
Covering clumpSurface(const Packing& packing, const ClumpOptions& options = {},
                      const Progress& progress = {});

}  // namespace innersphere
