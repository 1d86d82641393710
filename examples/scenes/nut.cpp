// A nut on a bolt.
#include <cmath>
#include <numbers>

#include "bullet_math.hpp"
#include "catalogue.hpp"
#include "innersphere/solids.hpp"
#include "measures.hpp"
#include "scene_solids.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

// Of the named solids; see makeNamedSolid().
constexpr double kPitch = 0.125, kClearance = 0.01, kNutHeight = 0.375;  // [m]
constexpr double kStart = 0.475;  // [m] of the nut above the bolt's head

// The result is the nut, with its threads touching those of the bolt from above.
btRigidBody& addNutOnBolt(SceneWorld& world, const SceneOptions& options, double friction) {
  const std::size_t bolt =
      world.addSolid(*makeNamedSolid("bolt"), options.spheres, progressOf(options, 0, 2));
  const std::size_t nut = world.addSolid(*makeNamedSolid("nut"), options.spheres, progressOf(options, 1, 2));
  btRigidBody& fixed =
      world.addBody(bolt, 0, at(0, 0, double(world.solids()[bolt].centre.z())), {0.62f, 0.64f, 0.67f});
  fixed.setFriction(1);
  // A clearance across flanks of 60 degrees leaves room along the axis.
  const double play = kClearance * std::tan(std::numbers::pi / 6);
  const btQuaternion turned = turn(vec(0, 0, 1), 2 * std::numbers::pi * kStart / kPitch);
  btRigidBody& body = world.addBody(nut, 1000, btTransform(turned, vec(0, 0, kStart + kNutHeight / 2 - play)),
                                    {0.95f, 0.70f, 0.27f});
  body.setFriction(btScalar(friction));
  world.film.has_ground = false;
  world.film.viewpoint = {0.4, 0.35, 0.45};
  return body;
}

}  // namespace

void buildNut(SceneWorld& world, const SceneOptions& options) {
  const btRigidBody& nut = addNutOnBolt(world, options, 0);
  const std::size_t index = world.indexOf(nut);
  // Energy: m g h = (m + I (2 pi / p)^2) v^2 / 2.
  const MassProperties& solid = world.solids()[1].packing->solid;
  const double turns = 2 * std::numbers::pi / kPitch;
  const double expected = 9.81 / (1 + solid.inertia[8] / solid.volume * turns * turns);
  world.expect({"acceleration along the axis", "m/s^2", Truth::Kind::equal, expected, 0.03 * expected,
                "g / (1 + I (2 pi / p)^2 / m), the screw without friction; 3 %",
                [index](const Recording& r) {
                  // By places: it rattles in its clearance, so that single speeds differ.
                  const std::size_t a = r.stepAt(0.3), c = r.steps.size() - 1, b = (a + c) / 2;
                  const auto speed = [&](std::size_t from, std::size_t to) {
                    return (r.body(index, from).position[2] - r.body(index, to).position[2]) /
                           (r.steps[to].time - r.steps[from].time);
                  };
                  return (speed(b, c) - speed(a, b)) / ((r.steps[c].time - r.steps[a].time) / 2);
                },
                1.5});
  world.expect({"turn over way down", "rad/m", Truth::Kind::equal, turns, 0.03 * turns, "2 pi / p",
                [index](const Recording& r) {
                  return turnedAboutZ(r, index, 0, r.seconds()) /
                         (r.last(index).position[2] - r.first(index).position[2]);
                },
                3.5});
  const double way = 0.5 * expected * options.seconds * options.seconds;
  world.expect(energyGainBelow(0.04, 9.81 / double(nut.getInvMass()) * way, "that of the way down"));
}

void buildNutHeld(SceneWorld& world, const SceneOptions& options) {
  // The thread rises by p / (2 pi r), 0.074 at its middle, and its flanks press 1 / cos(30 degrees) harder.
  constexpr double kFriction = 0.2;
  const std::size_t index = world.indexOf(addNutOnBolt(world, options, kFriction));
  world.expect(
      {"way down", "m", Truth::Kind::equal, 0, 0.001, "friction is above the slope of the thread: it holds",
       [index](const Recording& r) { return r.first(index).position[2] - r.last(index).position[2]; }, 2});
}

}  // namespace innersphere::demo
