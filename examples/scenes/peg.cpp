// A peg in a hole.
#include <cmath>

#include "bullet_math.hpp"
#include "catalogue.hpp"
#include "film/palette.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/solids.hpp"
#include "measures.hpp"
#include "scene_solids.hpp"
#include "shapes.hpp"
#include "world.hpp"

namespace innersphere::demo {

void buildPeg(SceneWorld& world, const SceneOptions& options) {
  constexpr double kRadius = 0.2, kLength = 0.6;  // [m] of the peg
  constexpr double kClearance = 0.01 * kRadius;   // [m] around it
  constexpr double kPlate = 0.3;                  // [m] thickness
  constexpr int kAround = 128;
  // The hole is a polygon whose edges touch the circle that is meant.
  const Outline ring =
      ringOutline(circlePoints(0.45, kAround),
                  circlePoints((kRadius + kClearance) / std::cos(SIMD_PI / kAround), kAround));
  const std::size_t plate =
      world.addSolid(*makeSolid(prism(ring, kPlate), "plate"), options.spheres, progressOf(options, 0, 2));
  const std::size_t peg =
      world.addSolid(*makeCylinder(kRadius, kLength), options.spheres, progressOf(options, 1, 2));
  world.addGround(0);
  world.addBody(plate, 0, at(0, 0, kPlate / 2), {0.62f, 0.64f, 0.67f});
  btRigidBody& body =
      world.addBody(peg, 1000, at(kClearance / 2, 0, kPlate + kLength / 2 + 0.02), paletteColour(0));
  body.setFriction(btScalar(0.1));
  const std::size_t index = world.indexOf(body);
  world.expect({"height of the peg", "m", Truth::Kind::equal, kLength / 2, 0.005 * kLength,
                "half its length: it stands on the ground; 0.5 % of it", finalCoordinate(index, 2), 1.5});
  world.expect({"way off the axis", "m", Truth::Kind::at_most, 2 * kClearance, 0,
                "clearance, and as much for the overlap of the walls",
                [index](const Recording& r) {
                  return std::hypot(r.last(index).position[0], r.last(index).position[1]);
                },
                1.5});
  world.film.viewpoint = {0.4, 0.4, 0.45, true};
}

}  // namespace innersphere::demo
