// Spheres as plain text, for and from other programs.
#pragma once

#include <string>

#include "innersphere/packing.hpp"

namespace innersphere {

/// A line `x y z r` for each sphere, in the coordinates of the solid, with as many digits as give the same
/// numbers back.
std::string toXyzr(const Packing& packing);

/// Lines of four numbers, separated by blanks or commas; empty lines and what follows a # are skipped. The
/// spheres are sorted by falling radius; the mass properties are those of the spheres. Throws Error
/// bad_format.
Packing fromXyzr(const std::string& text);

/// PLY points with a radius, as MeshLab, Blender and CloudCompare read them; in the coordinates of the solid.
std::string toPly(const Packing& packing);

}  // namespace innersphere
