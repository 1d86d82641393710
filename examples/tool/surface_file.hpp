// Triangle surfaces, for other programs.
#pragma once

#include <string>

#include "innersphere/packing.hpp"

namespace innersphere::tool {

/// True for the endings that writeSurface() knows: .obj and .stl.
bool isSurfaceFile(const std::string& path);

/// That of the solid that was packed, in the solid's own coordinates. Throws Error empty_input if the packing
/// has none.
Mesh surfaceOf(const Packing& packing);

/// Writes Wavefront OBJ, or STL: binary, or as text, with a note, where single precision would bend the
/// surface. Throws Error.
void writeSurface(const Mesh& mesh, const std::string& path, bool force);

}  // namespace innersphere::tool
