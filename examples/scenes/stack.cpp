// Boxes on boxes.
#include <cmath>
#include <string>

#include "bullet_math.hpp"
#include "catalogue.hpp"
#include "film/palette.hpp"
#include "innersphere/solids.hpp"
#include "measures.hpp"
#include "scene_solids.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

constexpr double kEdge = 0.5;  // [m]

std::size_t addBox(SceneWorld& world, const SceneOptions& options) {
  return world.addSolid(*makeBox({kEdge, kEdge, kEdge}), options.spheres, progressOf(options, 0, 1));
}

}  // namespace

void buildStack(SceneWorld& world, const SceneOptions& options) {
  constexpr std::size_t kBoxes = 10;
  constexpr double kDegree = 0.0174532925;
  const std::size_t box = addBox(world, options);
  world.addGround(0);
  for (std::size_t i = 0; i < kBoxes; ++i) {
    world.addBody(box, kDensity, at(0, 0, (static_cast<double>(i) + 0.5) * kEdge), paletteColour(i));
  }
  world.expect({"height of the highest box", "m", Truth::Kind::equal, (kBoxes - 0.5) * kEdge, 0.005 * kEdge,
                "9.5 edges; 0.5 % of an edge", finalCoordinate(kBoxes - 1, 2)});
  world.expect({"farthest way from the start", "m", Truth::Kind::at_most, 0.003, 0, "1 mm in 10 s",
                farthestOfAll(0, kBoxes)});
  world.expect({"largest turn", "rad", Truth::Kind::at_most, 0.5 * kDegree, 0, "half a degree",
                largestTurn(0, kBoxes)});
  world.film.viewpoint = {0.5, 0.3, 0.5};
}

void buildMassRatios(SceneWorld& world, const SceneOptions& options) {
  // Columns are so far apart that none reaches another one where it falls.
  constexpr double kRatios[] = {1, 10, 100, 1000}, kApart = 4 * kEdge;
  const std::size_t box = addBox(world, options);
  world.addGround(0);
  std::size_t column = 0;
  for (const double ratio : kRatios) {
    const double x = kApart * (static_cast<double>(column) - 1.5);
    world.addBody(box, kDensity, at(x, 0, 0.5 * kEdge), paletteColour(0));
    world.addBody(box, kDensity * ratio, at(x, 0, 1.5 * kEdge), paletteColour(column + 1));
    world
        .expect({"height of a box " + std::to_string(static_cast<int>(ratio)) +
                     " times as heavy as what it lies on",
                 "m", Truth::Kind::equal, 1.5 * kEdge, 0.005 * kEdge, "1.5 edges; 0.5 % of an edge",
                 finalCoordinate(2 * column + 1, 2), 2})
        .known_miss = ratio == 1000  ? 0.5
                      : ratio == 100 ? 0.12
                                     : 0;
    ++column;
  }
  world.film.viewpoint = {0.3, 0.25, 0.5};
}

}  // namespace innersphere::demo
