#include "film/palette.hpp"
#include "innersphere/solids.hpp"
#include "scene.hpp"
#include "scene_solids.hpp"
#include "world.hpp"

namespace innersphere::demo {

void buildChain(SceneWorld& world, const SceneOptions& options) {
  constexpr int kLinks = 10;
  constexpr double kRing = 0.2;                     // [m] radius of the ring
  constexpr double kTube = 0.05;                    // [m] radius of the tube
  constexpr double kDensity = 1000;                 // [kg/m^3]
  constexpr double kTilt = 0.9;                     // [rad] of the chain against the vertical at the start
  constexpr double kSpacing = 2 * (kRing - kTube);  // the tubes of neighbours touch

  const std::size_t torus =
      world.addSolid(*makeTorus(kRing, kTube), options.spheres, progressOf(options, 0, 1));
  const btQuaternion tilt(btVector3(0, 1, 0), btScalar(-kTilt));
  const btQuaternion upright(btVector3(0, 1, 0), SIMD_HALF_PI);
  const btQuaternion turned(btVector3(1, 0, 0), SIMD_HALF_PI);
  for (int i = 0; i < kLinks; ++i) {
    const btVector3 below(0, 0, btScalar(-kSpacing * i));
    const btQuaternion rotation = tilt * (i % 2 == 0 ? upright : turned);
    world.addBody(torus, i == 0 ? 0 : kDensity, btTransform(rotation, quatRotate(tilt, below)),
                  paletteColour(static_cast<std::size_t>(i)));
  }
  world.film.has_ground = false;
  world.film.viewpoint = {0.0, 0.1, 0.5};
}

}  // namespace innersphere::demo
