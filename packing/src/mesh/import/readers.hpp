// Reads the mesh formats that the project reads itself. Every count in a file is held against the bytes that
// are left before anything is allocated, so that memory and time follow from the size of the file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "innersphere/geometry.hpp"

namespace innersphere {

/// Return the triangles of a file: `bytes` is its content, `path` names it in messages. Coordinates keep all
/// digits of the file. Vertices are not welded. `notes` gets what a user should know. Throw Error with the
/// line or byte: bad_format, not_finite.
Mesh readObj(std::string_view bytes, const std::string& path);
Mesh readOff(std::string_view bytes, const std::string& path);
Mesh readPly(std::string_view bytes, const std::string& path);
Mesh readStl(std::string_view bytes, const std::string& path, std::vector<std::string>& notes);

}  // namespace innersphere
