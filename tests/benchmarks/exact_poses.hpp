// Poses of a solid and a moved copy of it, with what their overlap exactly is.
#pragma once

#include <string>
#include <vector>

#include "innersphere/placement.hpp"

namespace innersphere::benchmarks {

struct ExactPose {
  Placement placement;  ///< of the copy
  double volume = 0;    ///< of the overlap [m^3]
  Vec3d centroid{};     ///< of the overlap [m]
  Vec3d gradient{};     ///< of the volume, with respect to a translation of the copy [m^2]
};

/// Reads a table with a header row and the columns m00 to m23 (3 x 4, row by row), V, cx, cy, cz, gx, gy and
/// gz, in any order and among others; lines that start with # are skipped. Throws Error: file_not_found,
/// bad_format.
std::vector<ExactPose> readExactPoses(const std::string& path);

/// The same without the poses that do not overlap.
std::vector<ExactPose> readOverlappingPoses(const std::string& path);

}  // namespace innersphere::benchmarks
