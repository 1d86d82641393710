// What a user may have meant.
#pragma once

#include <string>
#include <vector>

namespace innersphere::tool {

/// The name that differs least from what was typed, by letters left out, added, changed or swapped with their
/// neighbour; empty if none is near, or several are equally near.
std::string nearest(const std::string& typed, const std::vector<std::string>& names);

/// "; did you mean NAME?", or `otherwise` if no name is near.
std::string didYouMean(const std::string& typed, const std::vector<std::string>& names,
                       const std::string& otherwise);

}  // namespace innersphere::tool
