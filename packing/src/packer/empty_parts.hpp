// Names parts of a solid that the spheres left out.
#pragma once

#include <string>
#include <vector>

#include "innersphere/packing.hpp"

namespace innersphere {

/// Returns a sentence for each closed shell of the surface with material right inside and no sphere's centre
/// in that material; of more than ten, the first ten and a sentence with the number of the others.
std::vector<std::string> nameEmptyParts(const Mesh& surface, const Packing& packing);

}  // namespace innersphere
