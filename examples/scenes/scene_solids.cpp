#include "scene_solids.hpp"

#include <memory>

#include "innersphere/solids.hpp"
#include "scaled_solid.hpp"
#include "world.hpp"

namespace innersphere::demo {

Progress progressOf(const SceneOptions& options, std::size_t index, std::size_t count) {
  if (!options.progress) return {};
  return [&options, index, count](const char*, double fraction) {
    return options.progress("packing", (static_cast<double>(index) + fraction) / static_cast<double>(count));
  };
}

std::vector<std::size_t> addSolids(SceneWorld& world, const SceneOptions& options,
                                   const std::vector<std::string>& names, double diagonal) {
  std::vector<std::shared_ptr<const Solid>> solids = options.solids;
  if (solids.empty()) {
    for (const std::string& name : names) solids.push_back(makeNamedSolid(name));
  }
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const std::shared_ptr<const Solid> solid = withDiagonal(solids[i], diagonal);
    indices.push_back(world.addSolid(*solid, options.spheres, progressOf(options, i, solids.size())));
  }
  return indices;
}

}  // namespace innersphere::demo
