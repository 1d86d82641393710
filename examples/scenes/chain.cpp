// Chains of interlocked rings.
#include <algorithm>
#include <cmath>
#include <string>

#include "bullet_math.hpp"
#include "catalogue.hpp"
#include "film/palette.hpp"
#include "innersphere/solids.hpp"
#include "measures.hpp"
#include "ring_distance.hpp"
#include "scene_solids.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

constexpr std::size_t kLinks = 10;
constexpr double kRing = 1, kTube = 0.25;         // [m]
constexpr double kSpacing = 2 * (kRing - kTube);  // the tubes of neighbours touch

// Hung at an angle against the vertical [rad]. The first link never moves.
void addLinks(SceneWorld& world, const SceneOptions& options, double angle, double last_density,
              std::size_t links = kLinks, double scale = 1) {
  const std::size_t torus =
      world.addSolid(*makeTorus(scale * kRing, scale * kTube), options.spheres, progressOf(options, 0, 1));
  const btQuaternion tilt = turn(vec(0, 1, 0), -angle);
  const btQuaternion upright = turn(vec(0, 1, 0), SIMD_HALF_PI), turned = turn(vec(1, 0, 0), SIMD_HALF_PI);
  for (std::size_t i = 0; i < links; ++i) {
    const btVector3 below = vec(0, 0, -scale * kSpacing * static_cast<double>(i));
    const double density = i == 0 ? 0 : i + 1 == links ? last_density : kDensity;
    world.addBody(torus, density,
                  btTransform(tilt * (i % 2 == 0 ? upright : turned), quatRotate(tilt, below)),
                  paletteColour(i));
  }
  world.film.has_ground = false;
  world.film.viewpoint = {0.0, 0.1, 0.5, true};
}

// Which of the body's axes is the ring's: the one with a moment of its own.
int axisOf(const btRigidBody& body) {
  const btVector3 m = body.getInvInertiaDiagLocal();
  return m.minAxis();
}

Truth& expectNoDeeper(SceneWorld& world, double limit, const std::string& source) {
  const int axis = axisOf(*world.bodies()[1].body);
  return world.expect({"deepest overlap of the tubes", "m", Truth::Kind::at_most, limit, 0, source,
                       [axis](const Recording& r) {
                         double nearest = 2 * kTube;
                         for (std::size_t s = 0; s < r.steps.size(); ++s) {
                           for (std::size_t i = 0; i + 1 < kLinks; ++i) {
                             nearest = std::min(nearest,
                                                distanceOfRings(r.body(i, s), r.body(i + 1, s), axis, kRing));
                           }
                         }
                         return 2 * kTube - nearest;
                       }});
}

double fallOfAll(const SceneWorld& world, double height) {
  double mass = 0;
  for (const SceneBody& body : world.bodies()) {
    if (body.moves()) mass += 1 / double(body.body->getInvMass());
  }
  return mass * 9.81 * height;
}

}  // namespace

void buildChainHang(SceneWorld& world, const SceneOptions& options) {
  addLinks(world, options, 0, kDensity);
  const double low = kSpacing * (kLinks - 1);
  world.expect({"height of the last link", "m", Truth::Kind::equal, -low, 0.005 * low,
                "9 (2 R - 2 r) below the first; 0.5 %", finalCoordinate(kLinks - 1, 2)});
  expectNoDeeper(world, 0.02, "GImpact with 2,304 triangles a ring");
  world.expect(energyGainBelow(0.0068, fallOfAll(world, kTube), "a fall of all links by the tube's radius"))
      .known_miss = options.dt > 0.01        ? 0.1
                    : options.spheres < 1000 ? 0.02
                                             : 0;
}

void buildChainSwing(SceneWorld& world, const SceneOptions& options) {
  constexpr double kAngle = 0.9;
  addLinks(world, options, kAngle, kDensity);
  expectNoDeeper(world, 0.02, "GImpact with 2,304 triangles a ring");
  // The links' centres hang 1.5, 3, ... 13.5 m below the first, 7.5 m on average.
  const double drop = 7.5 * (1 - std::cos(kAngle));
  world.expect(energyGainBelow(0.0031, fallOfAll(world, drop), "the fall from the start to the lowest place"))
      .known_miss = options.dt > 0.01 ? 0.01 : 0;
}

void buildChainHeavy(SceneWorld& world, const SceneOptions& options) {
  addLinks(world, options, 0, 100 * kDensity);
  expectNoDeeper(world, 0.05, "half of what a ring of 32 spheres needs to hold it");
  const double low = kSpacing * (kLinks - 1);
  world.expect({"height of the last link", "m", Truth::Kind::equal, -low, 0.02 * low,
                "9 (2 R - 2 r) below the first: no link is lost; 2 %", finalCoordinate(kLinks - 1, 2)});
}

void buildChainRest(SceneWorld& world, const SceneOptions& options) {
  constexpr std::size_t kLong = 20;
  constexpr double kScale = 0.1;  // links of 0.25 m
  addLinks(world, options, 0, kDensity, kLong, kScale);
  for (const SceneBody& body : world.bodies()) body.body->setFriction(btScalar(std::sqrt(0.3)));
  const auto largest = [](double StepRecord::*number) {
    return [number](const Recording& r) {
      double most = 0;
      for (std::size_t s = r.stepAt(r.seconds() - 1); s < r.steps.size(); ++s)
        most = std::max(most, r.steps[s].*number);
      return most;
    };
  };
  const char* source = "it is hung where it rests, and friction takes what comes in: nothing is seen to move";
  world.expect({"fastest turn of a link in the last second", "rad/s", Truth::Kind::at_most,
                2 * kRestMotion / kRestTime, 0, source, largest(&StepRecord::fastest_turn), 10});
  world.expect({"fastest link in the last second", "m/s", Truth::Kind::at_most,
                kRestMotion * 2 * kScale * (kRing + kTube) / kRestTime, 0, source,
                largest(&StepRecord::fastest), 10});
  const double low = kScale * kSpacing * (kLong - 1);
  world.expect({"height of the last link", "m", Truth::Kind::equal, -low, 0.005 * low,
                "19 (2 R - 2 r) below the first; 0.5 %", finalCoordinate(kLong - 1, 2), 10});
}

}  // namespace innersphere::demo
