#include "film/palette.hpp"
#include "innersphere/solids.hpp"
#include "scene.hpp"
#include "scene_solids.hpp"
#include "world.hpp"

namespace innersphere::demo {

void buildStack(SceneWorld& world, const SceneOptions& options) {
  constexpr int kBoxes = 5;
  constexpr double kEdge = 0.5;      // [m]
  constexpr double kDensity = 1000;  // [kg/m^3]
  const std::size_t box =
      world.addSolid(*makeBox({kEdge, kEdge, kEdge}), options.spheres, progressOf(options, 0, 1));
  world.addGround(0);
  for (int i = 0; i < kBoxes; ++i) {
    const btVector3 place(0, 0, btScalar((i + 0.5) * kEdge));
    world.addBody(box, kDensity, btTransform(btQuaternion::getIdentity(), place),
                  paletteColour(static_cast<std::size_t>(i)));
  }
  world.film.viewpoint = {0.5, 0.3, 0.5};
}

}  // namespace innersphere::demo
