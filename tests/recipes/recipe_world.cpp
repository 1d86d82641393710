#include "recipes/recipe_world.hpp"

#include "innersphere/packer.hpp"
#include "innersphere/solids.hpp"

namespace innersphere::recipes {
namespace {

std::shared_ptr<const CollisionModel> modelOf(const Solid& solid, bool overlap_errors = false) {
  PackOptions options;
  options.spheres = 256;
  options.overlap_errors = overlap_errors;
  return std::make_shared<CollisionModel>(std::make_shared<Packing>(pack(solid, options)));
}

}  // namespace

std::shared_ptr<const CollisionModel> torusModel() {
  static const auto model = modelOf(*makeTorus(0.2, kTubeRadius));
  return model;
}

std::shared_ptr<const CollisionModel> bracketModel() {
  static const auto model = modelOf(*makeNamedSolid("lbracket"));
  return model;
}

std::shared_ptr<const CollisionModel> boxModel(const Vec3d& size, bool overlap_errors) {
  return modelOf(*makeBox(size), overlap_errors);
}

}  // namespace innersphere::recipes
