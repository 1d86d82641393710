// Declares spheres that contain a solid, for planners and whoever must not miss a collision.
#pragma once

#include <string>
#include <vector>

#include "innersphere/geometry.hpp"
#include "innersphere/packing.hpp"

namespace innersphere {

/// Holds spheres that together contain a solid wholly. They overlap each other and reach out of the solid, so
/// they are no Packing: volumes that they share mean nothing.
struct Covering {
  Vec3d origin{};               ///< Where their frame is in the solid's coordinates [m], as in Packing.
  std::vector<Sphere> spheres;  ///< The spheres, in that frame.
  /// The mean distance from the solid of the surface of their union [m].
  double overhang_mean = 0;
  /// The largest of these distances, at points over all spheres [m].
  double overhang_max = 0;
  MassProperties solid;   ///< The exact mass properties of the solid, not of the spheres.
  Provenance provenance;  ///< Where the covering comes from.
};

/// Writes a covering; the format follows from the ending: .json, which says what it is, or .ply and .xyzr
/// with the spheres only. readPacking() refuses the first. The file appears under its name only when it is
/// complete. An existing file is replaced only with `overwrite`. Throws Error: bad_argument (unknown ending),
/// file_exists, write_failed.
void writeCovering(const Covering& covering, const std::string& path, bool overwrite = false);

}  // namespace innersphere
