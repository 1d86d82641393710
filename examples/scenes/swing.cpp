// Bodies that slide without friction on a circle: a ring on a peg, a ball in a half-pipe.
#include <cmath>
#include <numbers>

#include "bullet_math.hpp"
#include "catalogue.hpp"
#include "film/palette.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/solids.hpp"
#include "measures.hpp"
#include "pendulum.hpp"
#include "scene_solids.hpp"
#include "shapes.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

constexpr Colour kFixed{0.62f, 0.64f, 0.67f};
const btQuaternion kAlongY = turn(vec(1, 0, 0), SIMD_HALF_PI);  // turns z to -y, y to z

// A body whose centre is let go on the circle, without friction.
void letGo(SceneWorld& world, std::size_t solid, const btQuaternion& rotation, const Pendulum& pendulum) {
  const btVector3 hang =
      pendulum.length * vec(std::sin(pendulum.amplitude), 0, -std::cos(pendulum.amplitude));
  const auto& [x, y, z] = pendulum.pivot;
  btRigidBody& body =
      world.addBody(solid, kDensity, btTransform(rotation, vec(x, y, z) + hang), paletteColour(0));
  body.setFriction(0);
  body.setActivationState(DISABLE_DEACTIVATION);  // Bullet takes so slow a swing for rest
  expectPendulum(world, world.indexOf(body), pendulum);
  world.film.has_ground = false;
}

void addRingOnPeg(SceneWorld& world, const SceneOptions& options, bool packed) {
  constexpr double kRing = 0.5, kTube = 0.1, kPeg = 0.05, kLength = 0.6;  // [m]
  const std::size_t ring =
      world.addSolid(*makeTorus(kRing, kTube), options.spheres, progressOf(options, 0, 2));
  const btTransform place(kAlongY, vec(0, 0, 0));
  if (packed) {
    const std::size_t peg =
        world.addSolid(*makeCylinder(kPeg, kLength), options.spheres, progressOf(options, 1, 2));
    world.addBody(peg, 0, place, kFixed);
  } else {
    world.addFixedCylinder(kPeg, kLength, place, kFixed);
  }
  letGo(world, ring, kAlongY, {{0, 0, 0}, kRing - kTube - kPeg, 0.3, 5, packed ? 0 : 0.9});
  world.expect({"turn of the ring", "rad", Truth::Kind::at_most, 0.1, 0,
                "the push of the peg goes through its centre: it does not turn", largestTurn(1, 1), 6});
  world.film.viewpoint = {0.5, 0.3, 0.45, true};
}

constexpr double kPipe = 1, kWall = 0.1, kPipeLength = 0.6;  // [m] inner radius, thickness

// The lower half of a pipe along z, its centre line at the origin. With 360 facets their edges take 2 % of
// the energy in a swing, as each turns the way of the ball by half a degree.
Mesh halfPipe() {
  constexpr std::uint32_t kFacets = 360;
  Outline outline;
  for (const double radius : {kPipe, kPipe + kWall}) {
    for (std::uint32_t i = 0; i <= kFacets; ++i) {
      const double angle = std::numbers::pi * (1 + double(i) / kFacets);
      outline.add({radius * std::cos(angle), radius * std::sin(angle)});
    }
  }
  for (std::uint32_t i = 0; i < kFacets; ++i) {
    outline.addQuad(i, kFacets + 1 + i, kFacets + 2 + i, i + 1);
  }
  return prism(outline, kPipeLength);
}

void addBallInPipe(SceneWorld& world, const SceneOptions& options, bool packed) {
  constexpr double kBall = 0.2;  // [m] radius
  const std::size_t ball = world.addSolid(*makeBall(kBall), options.spheres, progressOf(options, 0, 2));
  const btTransform mesh(kAlongY, vec(0, kPipeLength / 2, 0));
  if (packed) {
    const auto pipe = makeSolid(halfPipe(), "half-pipe");
    const std::size_t solid = world.addSolid(*pipe, options.spheres, progressOf(options, 1, 2));
    world.addBody(solid, 0, placeOf(*pipe, mesh), kFixed);
  } else {
    world.addFixedMesh(halfPipe(), mesh, kFixed);
  }
  letGo(world, ball, btQuaternion::getIdentity(), {{0, 0, 0}, kPipe - kBall, 0.5});
  world.film.viewpoint = {0.3, 0.4, 0.45, true};
}

}  // namespace

void buildRingPeg(SceneWorld& world, const SceneOptions& options) {
  addRingOnPeg(world, options, true);
}

void buildRingCylinder(SceneWorld& world, const SceneOptions& options) {
  addRingOnPeg(world, options, false);
}

void buildHalfPipe(SceneWorld& world, const SceneOptions& options) {
  addBallInPipe(world, options, true);
}

void buildHalfPipeMesh(SceneWorld& world, const SceneOptions& options) {
  addBallInPipe(world, options, false);
}

}  // namespace innersphere::demo
