// Arches of stones without mortar.
#include <cmath>
#include <numbers>

#include "bullet_math.hpp"
#include "catalogue.hpp"
#include "film/palette.hpp"
#include "innersphere/mesh.hpp"
#include "measures.hpp"
#include "scene_solids.hpp"
#include "shapes.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

constexpr int kStones = 11;
constexpr double kRadius = 1, kDepth = 0.5;  // [m] of the middle line; of the arch along y

// A semicircle of wedges with plane faces that stands on the ground.
void addArch(SceneWorld& world, const SceneOptions& options, double thickness) {
  constexpr double kHalf = std::numbers::pi / kStones / 2;  // [rad]
  const double inner = kRadius - thickness / 2, outer = kRadius + thickness / 2;
  const double s = std::sin(kHalf), c = std::cos(kHalf);
  Outline wedge;
  wedge.addQuad(wedge.add({-inner * s, inner * c}), wedge.add({inner * s, inner * c}),
                wedge.add({outer * s, outer * c}), wedge.add({-outer * s, outer * c}));
  const std::size_t stone =
      world.addSolid(*makeSolid(prism(wedge, kDepth), "stone"), options.spheres, progressOf(options, 0, 1));
  world.addGround(0);
  const btQuaternion upright = turn(vec(1, 0, 0), SIMD_HALF_PI);
  for (int i = 0; i < kStones; ++i) {
    const btQuaternion lean = turn(vec(0, 1, 0), -std::numbers::pi / 2 + (2 * i + 1) * kHalf);
    world.addBody(stone, 2400, btTransform(lean * upright, quatRotate(lean, vec(0, 0, kRadius * c))),
                  paletteColour(static_cast<std::size_t>(i)));
  }
  world.film.viewpoint = {0.35, 0.25, 0.45, true};
}

}  // namespace

void buildArch(SceneWorld& world, const SceneOptions& options) {
  addArch(world, options, 0.25 * kRadius);
  world.expect(
      {"farthest way of a stone", "m", Truth::Kind::at_most, 0.01 * kRadius, 0,
       "it stands: a line of thrust fits into it from a thickness of 0.1075 R on (Milankovitch; 0.105 R "
       "for these stones); 1 % of R",
       farthestOfAll(0, kStones), 10});
}

void buildArchThin(SceneWorld& world, const SceneOptions& options) {
  addArch(world, options, 0.09 * kRadius);
  world.expect({"height of the keystone", "m", Truth::Kind::at_most, 0.5 * kRadius, 0,
                "it falls: no line of thrust fits into less than 0.105 R", finalCoordinate(kStones / 2, 2),
                5});
}

}  // namespace innersphere::demo
