// Friction that makes bodies roll, or stop spinning.
#include <cmath>

#include "bullet_math.hpp"
#include "catalogue.hpp"
#include "film/palette.hpp"
#include "innersphere/solids.hpp"
#include "scene_solids.hpp"
#include "world.hpp"

namespace innersphere::demo {

void buildRoll(SceneWorld& world, const SceneOptions& options) {
  constexpr double kRadius = 0.2, kSpeed = 2, kFriction = 0.3;  // [m], [m/s]
  const std::size_t ball = world.addSolid(*makeBall(kRadius), options.spheres, progressOf(options, 0, 2));
  const std::size_t cylinder =
      world.addSolid(*makeCylinder(kRadius, 0.4), options.spheres, progressOf(options, 1, 2));
  world.addGround(0).setFriction(1);
  const auto start = [&](std::size_t solid, const btTransform& place, const char* name, double share,
                         const char* source) {
    btRigidBody& body = world.addBody(solid, 1000, place, paletteColour(solid));
    body.setFriction(btScalar(kFriction));
    body.setLinearVelocity(vec(kSpeed, 0, 0));
    const std::size_t index = world.indexOf(body);
    world.expect({std::string("speed of the rolling ") + name, "m/s", Truth::Kind::equal, share * kSpeed,
                  0.01 * kSpeed, source, [index](const Recording& r) { return r.last(index).velocity[0]; },
                  0.5});
    world.expect(
        {std::string("slip of the rolling ") + name, "m/s", Truth::Kind::equal, 0, 0.01 * kSpeed,
         "v - spin x r = 0",
         [index](const Recording& r) { return r.last(index).velocity[0] - r.last(index).spin[1] * kRadius; },
         0.5});
  };
  start(ball, at(0, -0.4, kRadius), "ball", 5.0 / 7, "5/7 v: v / (1 + I / (m r^2)), I = 2/5 m r^2");
  start(cylinder, btTransform(turn(vec(1, 0, 0), SIMD_HALF_PI), vec(0, 0.4, kRadius)), "cylinder", 2.0 / 3,
        "2/3 v: v / (1 + I / (m r^2)), I = 1/2 m r^2");
  world.film.viewpoint = {0.3, 0.3, 0.5, true};
}

void buildTorsion(SceneWorld& world, const SceneOptions& options) {
  constexpr double kRing = 0.2, kTube = 0.05, kRadius = 0.2, kFriction = 0.2, kSpin = 10;  // [m], [rad/s]
  const std::size_t torus =
      world.addSolid(*makeTorus(kRing, kTube), options.spheres, progressOf(options, 0, 2));
  const std::size_t disc =
      world.addSolid(*makeCylinder(kRadius, 0.1), options.spheres, progressOf(options, 1, 2));
  world.addGround(0).setFriction(1);
  const auto start = [&](std::size_t solid, double x, const char* name, double expected, const char* source) {
    btRigidBody& body = world.addBody(solid, 1000, at(x, 0, 0.05), paletteColour(solid));
    body.setFriction(btScalar(kFriction));
    body.setAngularVelocity(vec(0, 0, kSpin));
    world.expect({std::string("angular deceleration of the ") + name, "rad/s^2", Truth::Kind::equal, expected,
                  0.03 * expected, source,
                  [index = world.indexOf(body)](const Recording& r) {
                    return (r.body(index, r.stepAt(0.1)).spin[2] - r.body(index, r.stepAt(0.5)).spin[2]) /
                           0.4;
                  },
                  0.5});
  };
  constexpr double kPull = kFriction * 9.81;
  start(torus, -0.4, "torus", kPull * kRing / (kRing * kRing + 0.75 * kTube * kTube),
        "friction m g R / I: it touches on a circle; I = m (R^2 + 3/4 r^2)");
  start(disc, 0.4, "disc", 4.0 / 3 * kPull / kRadius,
        "2/3 friction m g R / I: even pressure on a disc; I = m R^2 / 2");
  world.film.viewpoint = {0.3, 0.4, 0.45, true};
}

}  // namespace innersphere::demo
