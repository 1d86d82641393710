// Reads the mesh formats that assimp knows.
#pragma once

#include <string>

#include "innersphere/geometry.hpp"

namespace innersphere {

/// Returns the triangles of all nodes, in the frame of the file, with transforms applied in double. Vertices
/// are not welded; their coordinates went through single precision. Throws Error: bad_format, not_finite.
Mesh readAssimp(const std::string& path);

}  // namespace innersphere
