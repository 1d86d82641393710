#include "scene_solids.hpp"

#include <memory>

#include "bullet_math.hpp"
#include "innersphere/solids.hpp"
#include "scaled_solid.hpp"
#include "world.hpp"

namespace innersphere::demo {

btTransform placeOf(const Solid& solid, const btTransform& mesh) {
  const Bounds b = solid.bounds();
  return mesh * at((b.min[0] + b.max[0]) / 2, (b.min[1] + b.max[1]) / 2, (b.min[2] + b.max[2]) / 2);
}

Progress progressOf(const SceneOptions& options, std::size_t index, std::size_t count) {
  if (!options.progress) return {};
  return [&options, index, count](const char*, double fraction) {
    return options.progress("packing", (static_cast<double>(index) + fraction) / static_cast<double>(count));
  };
}

std::vector<std::size_t> addSolids(SceneWorld& world, const SceneOptions& options,
                                   const std::vector<std::string>& names, double diagonal) {
  std::vector<std::shared_ptr<const Solid>> solids;
  for (const std::string& name : names) {
    if (options.solids.empty()) solids.push_back(makeNamedSolid(name));
  }
  return addSolids(world, options, solids, diagonal);
}

std::vector<std::size_t> addSolids(SceneWorld& world, const SceneOptions& options,
                                   const std::vector<std::shared_ptr<const Solid>>& solids, double diagonal) {
  const auto& used = options.solids.empty() ? solids : options.solids;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const std::shared_ptr<const Solid> solid = withDiagonal(used[i], diagonal);
    indices.push_back(world.addSolid(*solid, options.spheres, progressOf(options, i, used.size())));
  }
  return indices;
}

}  // namespace innersphere::demo
