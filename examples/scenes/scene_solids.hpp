// The solids that a scene packs.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "scene.hpp"

namespace innersphere::demo {

/// Packs the user's solids or, without any, the project's of these names; each scaled so that its bounding
/// box has this diagonal [m]. The results are indices for SceneWorld::addBody(). Throws Error as pack() does.
std::vector<std::size_t> addSolids(SceneWorld& world, const SceneOptions& options,
                                   const std::vector<std::string>& names, double diagonal);

/// The same, with these solids in place of the project's.
std::vector<std::size_t> addSolids(SceneWorld& world, const SceneOptions& options,
                                   const std::vector<std::shared_ptr<const Solid>>& solids, double diagonal);

/// Where the centre of a solid's bounding box is, which is what SceneWorld::addBody() asks for, if the frame
/// of its mesh is at `mesh`.
btTransform placeOf(const Solid& solid, const btTransform& mesh);

/// Reports the packing of solid `index` of `count` as a part of one progress.
Progress progressOf(const SceneOptions& options, std::size_t index, std::size_t count);

}  // namespace innersphere::demo
