// Shows which parts of a surface have spheres near them.
#pragma once

#include <string>

#include "film/film.hpp"
#include "innersphere/packing.hpp"

namespace innersphere::tool {

/// Adds the surface of a packing, coloured by the distance to the nearest sphere in bands of a quarter of a
/// percent to eight percent of the diagonal. Returns a sentence that explains the colours. Throws Error
/// empty_input if there is no surface.
std::string addCoverage(const Packing& packing, demo::Film& film);

}  // namespace innersphere::tool
