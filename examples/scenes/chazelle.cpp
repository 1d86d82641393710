// Chazelle polyhedra.
#include <algorithm>

#include "bullet_math.hpp"
#include "catalogue.hpp"
#include "film/palette.hpp"
#include "innersphere/solids.hpp"
#include "measures.hpp"
#include "scene_solids.hpp"
#include "world.hpp"

namespace innersphere::demo {

void buildChazelle(SceneWorld& world, const SceneOptions& options) {
  constexpr double kEdge = 1, kPushed = 0.04;  // [m]; how deep they are in each other at the start
  const std::size_t solid =
      world.addSolid(*makeNamedSolid("chazelle"), options.spheres, progressOf(options, 0, 1));
  world.addBody(solid, 0, at(0, 0, kEdge / 2), paletteColour(1));
  // Turned, so that its notches cross those of the lower one.
  world.addBody(solid, 1000, btTransform(turn(vec(0, 0, 1), 0.4), vec(0, 0, 1.5 * kEdge - kPushed)),
                paletteColour(0));
  world.expect({"height of the upper one", "m", Truth::Kind::equal, 1.5 * kEdge, 0.005 * kEdge,
                "a flat face on a flat face, where neither is notched; 0.5 % of its size",
                finalCoordinate(1, 2), 4});
  world.expect({"highest place of the upper one", "m", Truth::Kind::at_most, 1.5 * kEdge + kPushed, 0,
                "it is not thrown higher than it was pushed in", [](const Recording& r) {
                  double highest = 0;
                  for (std::size_t s = 0; s < r.steps.size(); ++s)
                    highest = std::max(highest, r.body(1, s).position[2]);
                  return highest;
                }});
  world.expect({"speed at the end", "m/s", Truth::Kind::at_most, 0.002, 0, "it has come to rest",
                [](const Recording& r) { return r.steps.back().fastest; }, 4});
  world.film.viewpoint = {0.5, 0.35, 0.45};
}

}  // namespace innersphere::demo
