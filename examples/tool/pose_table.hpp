// Poses from a CSV file.
#pragma once

#include <string>
#include <vector>

#include "innersphere/placement.hpp"

namespace innersphere::tool {

struct NamedPose {
  std::string name;  ///< column "pose", or the number of the row, from 0
  Placement placement;
};

/// Reads a table with a header row and the columns m00, m01, ..., m23: the 3x4 matrix of a rigid transform,
/// row by row. Other columns, empty lines, lines that start with # and a byte-order mark are passed over.
/// Throws Error file_not_found, bad_format (also for a row with more fields than the header and for a matrix
/// that is not a rotation), not_finite, empty_input; the message names the line.
std::vector<NamedPose> readPoses(const std::string& path);

}  // namespace innersphere::tool
