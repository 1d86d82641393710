// Declares spheres that overlap each other: those that contain a solid, for planners and whoever must not
// miss a collision, and those whose union is as near to it as can be, for grains and haptics.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "innersphere/geometry.hpp"
#include "innersphere/packing.hpp"

namespace innersphere {

/// Tells what spheres that overlap each other are for.
enum class CoveringKind {
  contains,  ///< Together they contain the solid wholly (coverSolid()).
  clump      ///< Their union is as near to the solid as can be: a multi-sphere particle (clumpSolid()).
};

/// Holds spheres that overlap each other and reach out of their solid, so they are no Packing: volumes that
/// they share mean nothing.
struct Covering {
  CoveringKind kind = CoveringKind::contains;  ///< Whether they contain the solid.
  Vec3d origin{};               ///< Where their frame is in the solid's coordinates [m], as in Packing.
  std::vector<Sphere> spheres;  ///< The spheres, in that frame.
  /// The part of the solid's volume that is in a sphere: 1 if they contain it.
  double inside = 1;
  /// The volume of their union that is outside of the solid, relative to the solid's.
  double outside = 0;
  /// The mean distance from the solid of the surface of their union [m]; of what is inside it is 0.
  double overhang_mean = 0;
  /// The largest of these distances, at points over all spheres [m].
  double overhang_max = 0;
  /// The mean distance from the solid's surface to the nearest sphere [m]; of what is in one it is 0.
  double gap_mean = 0;
  /// The largest of these distances, at 50,000 points spread over the surface [m].
  double gap_max = 0;
  MassProperties solid;   ///< The exact mass properties of the solid, not of the spheres.
  MassProperties united;  ///< Those of the union of the spheres, to about 1e-4.
  /// Densities relative to the solid's, one for each sphere, as in Packing: where spheres overlap both count.
  /// Empty if the spheres cannot have the solid's volume, centre of mass and inertia.
  std::vector<float> mass_weights;
  Provenance provenance;  ///< Where the covering comes from.
};

/// Reads what writeCovering() has written as .json, bit for bit; nothing if the file is JSON, but of another
/// kind, as a packing is. No bytes in a file crash it. Throws Error: file_not_found, bad_format,
/// unsupported_version.
std::optional<Covering> readCovering(const std::string& path);

/// Writes a covering or clump; the format follows from the ending: .json, which says what it is, or .ply and
/// .xyzr with the spheres only. readPacking() refuses the first. The file appears under its name only when it
/// is complete. An existing file is replaced only with `overwrite`. Throws Error: bad_argument (unknown
/// ending), file_exists, write_failed.
void writeCovering(const Covering& covering, const std::string& path, bool overwrite = false);

}  // namespace innersphere
