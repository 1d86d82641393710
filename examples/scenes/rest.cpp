// Bodies at rest on a plane.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

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

constexpr double kGravity = 9.81;  // [m/s^2]

double longestEdge(const Bounds& b) {
  return std::max({b.max[0] - b.min[0], b.max[1] - b.min[1], b.max[2] - b.min[2]});
}

// How deep a ball of this radius sinks until its cap has a volume: V = pi d^2 (3 r - d) / 3.
double depthOfCap(double radius, double volume) {
  double low = 0, high = 2 * radius;
  for (int i = 0; i < 100; ++i) {
    const double d = (low + high) / 2;
    (std::numbers::pi * d * d * (3 * radius - d) / 3 < volume ? low : high) = d;
  }
  return low;
}

}  // namespace

void buildRest(SceneWorld& world, const SceneOptions& options) {
  constexpr double kDrop = 0.005;  // [m] so that it settles instead of being put down
  constexpr double kApart = 0.75;  // [m]
  std::vector<std::shared_ptr<const Solid>> solids;
  solids.push_back(makeBox({0.5, 0.5, 0.5}));
  solids.push_back(makeBall(0.25));
  solids.push_back(makeTorus(0.2, 0.08));
  solids.push_back(makeCylinder(0.2, 0.4));
  solids.push_back(withDiagonal(makeNamedSolid("gear"), 0.7));
  world.addGround(0);
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const std::size_t solid =
        world.addSolid(*solids[i], options.spheres, progressOf(options, i, solids.size()));
    const Bounds b = solids[i]->bounds();
    const double half = (b.max[2] - b.min[2]) / 2;
    const double x = kApart * (static_cast<double>(i) - 2);
    btRigidBody& body = world.addBody(solid, kDensity, at(x, 0, half + kDrop), paletteColour(i));
    world.expect({"height of the " + solids[i]->name(), "m", Truth::Kind::equal, half, 0.005 * longestEdge(b),
                  "half of the solid's height; 0.5 % of its size", finalCoordinate(world.indexOf(body), 2),
                  1});
  }
  world.expect(
      {"creep in the last second", "m", Truth::Kind::at_most, 1e-4, 0, "bodies at rest rest",
       [count = solids.size()](const Recording& r) { return farthestOfAll(0, count, r.seconds() - 1)(r); },
       2});
  world.film.viewpoint = {0.35, 0.35, 0.45};
}

void buildSoft(SceneWorld& world, const SceneOptions& options) {
  constexpr double kEdge = 0.5, kRadius = 0.25;  // [m]
  const double stiffness = options.contact.stiffness;
  const std::size_t box =
      world.addSolid(*makeBox({kEdge, kEdge, kEdge}), options.spheres, progressOf(options, 0, 2));
  const std::size_t ball = world.addSolid(*makeBall(kRadius), options.spheres, progressOf(options, 1, 2));
  world.addGround(0);
  world.addBody(box, kDensity, at(-0.4, 0, kEdge / 2), paletteColour(0));
  world.addBody(ball, kDensity, at(0.4, 0, kRadius), paletteColour(1));
  const double box_depth = kDensity * kGravity * kEdge / stiffness;
  const double ball_volume = 4.0 / 3 * std::numbers::pi * std::pow(kRadius, 3);
  const double ball_depth = depthOfCap(kRadius, kDensity * kGravity * ball_volume / stiffness);
  // Spheres that stand for the volume up to a flat face do not reach it with all of that: what a plane cuts
  // off 2 % deep is 19 % too little with 1,000 of them, 9 % with 4,000, 2 % with 16,000, and the box sinks
  // deeper.
  world
      .expect({"depth of the box", "m", Truth::Kind::equal, box_depth, 0.05 * box_depth,
               "weight = stiffness x area x depth",
               [](const Recording& r) { return kEdge / 2 - r.last(0).position[2]; }, 2})
      .known_miss = options.spheres < 16000 ? 0.0018 : 0;
  world.expect({"depth of the ball", "m", Truth::Kind::equal, ball_depth, 0.05 * ball_depth,
                "weight = stiffness x volume of the cap, pi d^2 (3 r - d) / 3",
                [](const Recording& r) { return kRadius - r.last(1).position[2]; }, 2});
  world.film.viewpoint = {0.35, 0.2, 0.45};
}

}  // namespace innersphere::demo
