// Writes spheres as plain text for other programs, and reads it.
#pragma once

#include <string>

#include "innersphere/packing.hpp"

namespace innersphere {

/// Returns a line `x y z r` for each sphere [m], in the coordinates of the solid, with as many digits as give
/// the same numbers back.
std::string toXyzr(const Packing& packing);

/// Reads lines of four numbers [m], separated by blanks, commas or semicolons; empty lines and what follows a
/// # are skipped. The spheres are sorted by falling radius; the mass properties are those of the spheres.
/// Throws Error bad_format.
Packing fromXyzr(const std::string& text);

/// Returns PLY points with a radius, as MeshLab, Blender and CloudCompare read them, in the coordinates of
/// the solid.
std::string toPly(const Packing& packing);

}  // namespace innersphere
