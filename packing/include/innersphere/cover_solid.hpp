// Contains a solid in spheres.
#pragma once

#include "innersphere/covering.hpp"
#include "innersphere/progress.hpp"
#include "innersphere/solid.hpp"

namespace innersphere {

/// Says how coverSolid() works.
struct CoverOptions {
  /// The side of the smallest cells that are proven to be contained, relative to the diagonal of the solid's
  /// bounding box, 1e-4 to 0.1. Spheres are larger than they must be by at most sqrt(3) times this. Half of
  /// it takes up to four times as long.
  double resolution = 0.002;
  /// The number of threads. 0: all cores. The result does not depend on it.
  int threads = 0;
};

/// Returns as many spheres as the packing has that contain all of the solid that it was made of. Its spheres
/// are where they start: each in turn becomes the smallest that holds those points of the solid that are
/// nearest to it, as long as the spheres become smaller that way. Cells of an octree then prove that no point
/// is left out, of the inside neither; where one is not in a sphere, that sphere grows that has to grow
/// least. Packings in SphereOrder::coverage give the tightest spheres. Throws Error: bad_argument (options,
/// no spheres), not_finite (the solid's distances), cancelled.
Covering coverSolid(const Solid& solid, const Packing& packing, const CoverOptions& options = {},
                    const Progress& progress = {});

/// Does the same for the solid that the packing's own surface bounds: triangles, and in single precision.
/// Throws Error also: empty_input (the packing has no surface).
Covering coverSurface(const Packing& packing, const CoverOptions& options = {},
                      const Progress& progress = {});

}  // namespace innersphere
