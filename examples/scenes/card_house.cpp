// A card-house of brackets.
#include <cmath>

#include "bullet_math.hpp"
#include "catalogue.hpp"
#include "film/palette.hpp"
#include "innersphere/solids.hpp"
#include "measures.hpp"
#include "scaled_solid.hpp"
#include "scene_solids.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

constexpr double kArm = 0.5;     // [m] length of a bracket's arms; they are 0.3 of it wide and thick
constexpr double kPlank = 0.05;  // [m] thickness
const double kTent = 1.3 * kArm / std::sqrt(2.0);  // [m] height of a bracket that stands on its arms' ends

// Where the centre of a bracket's bounding box is if it stands on its arms like a tent with its ridge along y
// and its feet at height z. Its own x and y axes point down, to the right and to the left.
btTransform tentAt(double x, double z) {
  const btScalar s = btScalar(std::sqrt(0.5));
  const btMatrix3x3 axes(s, -s, 0, 0, 0, 1, -s, -s, 0);
  return btTransform(axes, vec(x, 0, z + kTent - kArm * std::sqrt(0.5)));
}

}  // namespace

void buildCardHouse(SceneWorld& world, const SceneOptions& options) {
  constexpr double kApart = 0.76;  // [m] of the lower two
  const std::size_t bracket = world.addSolid(*scaledSolid(makeNamedSolid("lbracket"), kArm), options.spheres,
                                             progressOf(options, 0, 2));
  const std::size_t plank =
      world.addSolid(*makeBox({1.1, 0.2, kPlank}), options.spheres, progressOf(options, 1, 2));
  world.addGround(0);
  world.addBody(bracket, 1000, tentAt(-kApart / 2, 0), paletteColour(0));
  world.addBody(bracket, 1000, tentAt(kApart / 2, 0), paletteColour(1));
  world.addBody(plank, 500, at(0, 0, kTent + kPlank / 2), paletteColour(2));
  world.addBody(bracket, 500, tentAt(0, kTent + kPlank), paletteColour(3));
  world.expect({"farthest way from the start", "m", Truth::Kind::at_most, 0.002, 0,
                "every body is in equilibrium where it is put", farthestOfAll(0, 4)});
  world.expect({"largest turn", "rad", Truth::Kind::at_most, 0.0087, 0, "half a degree", largestTurn(0, 4)});
  world.film.viewpoint = {0.35, 0.2, 0.45, true};
}

}  // namespace innersphere::demo
