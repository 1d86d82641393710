// A body falls.
#include "bullet_math.hpp"
#include "catalogue.hpp"
#include "film/palette.hpp"
#include "innersphere/solids.hpp"
#include "measures.hpp"
#include "scene_solids.hpp"
#include "world.hpp"

namespace innersphere::demo {

void buildDrop(SceneWorld& world, const SceneOptions& options) {
  constexpr double kRing = 0.35, kTube = 0.15, kHeight = 1;  // [m]
  const std::size_t torus =
      world.addSolid(*makeTorus(kRing, kTube), options.spheres, progressOf(options, 0, 1));
  world.addGround(0);
  const btTransform place(turn(vec(1, 0.3, 0), 1.2), vec(0, 0, kHeight + 0.5));
  btRigidBody& body = world.addBody(torus, kDensity, place, paletteColour(0));
  const double weight = 9.81 / double(body.getInvMass());
  world.expect({"height at rest", "m", Truth::Kind::equal, kTube, 0.005 * 2 * (kRing + kTube),
                "the tube's radius: it lies flat; 0.5 % of its size", finalCoordinate(0, 2), 8});
  world.expect({"speed at the end", "m/s", Truth::Kind::at_most, 0.002, 0, "it has come to rest",
                [](const Recording& r) { return r.steps.back().fastest; }, 8});
  world.expect(energyGainBelow(0.013, weight * kHeight, "that of a fall by 1 m"));
  world.film.viewpoint = {0.4, 0.3, 0.45, true};
}

}  // namespace innersphere::demo
