// The solids that a scene packs.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scene.hpp"

namespace innersphere::demo {

/// Packs the user's solids or, without any, the project's of these names; each scaled so that its bounding
/// box has this diagonal [m]. The results are indices for SceneWorld::addBody(). Throws Error as pack() does.
std::vector<std::size_t> addSolids(SceneWorld& world, const SceneOptions& options,
                                   const std::vector<std::string>& names, double diagonal);

/// Reports the packing of solid `index` of `count` as a part of one progress.
Progress progressOf(const SceneOptions& options, std::size_t index, std::size_t count);

}  // namespace innersphere::demo
