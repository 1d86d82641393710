// A row of dominoes that knock each other over.
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "bullet_math.hpp"
#include "catalogue.hpp"
#include "film/palette.hpp"
#include "innersphere/solids.hpp"
#include "scene_solids.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

constexpr int kDominoes = 20, kFrom = 5, kTo = 15;             // the wave is timed between these two
constexpr double kThick = 0.08, kWide = 0.24, kHeight = 0.48;  // [m]
constexpr double kApart = 0.24;                                // [m] from face to the same face of the next
constexpr double kLean = 0.2;                                  // [rad] of the first one: beyond its balance
constexpr double kFallen = 0.2;                                // [rad]
constexpr double kSeconds = 4;

btTransform placeOfDomino(int i) {
  const double x = kApart * i;
  if (i > 0) return at(x, 0, kHeight / 2);
  const btQuaternion lean = turn(vec(0, 1, 0), kLean);
  const btVector3 edge = vec(x + kThick / 2, 0, 0);
  return btTransform(lean, edge + quatRotate(lean, vec(-kThick / 2, 0, kHeight / 2)));
}

double speedOf(double from, double to) {
  return to > from ? (kTo - kFrom) * kApart / (to - from) : 0;
}

// The speed of the wave [m/s] with Bullet's boxes in steps of 1/960 s.
double speedOfBullets() {
  constexpr double kDt = 1.0 / 960;
  SceneWorld world{ContactOptions{}};
  world.addGround(0);
  const double mass = kDensity * kThick * kWide * kHeight;
  for (int i = 0; i < kDominoes; ++i) {
    world.addBox(vec(kThick, kWide, kHeight) / 2, mass, placeOfDomino(i), {});
  }
  double times[kDominoes] = {};
  for (int step = 1; step * kDt <= kSeconds; ++step) {
    world.step(kDt);
    for (const int i : {kFrom, kTo}) {
      const btScalar up =
          world.bodies()[static_cast<std::size_t>(i)].body->getWorldTransform().getBasis()[2][2];
      if (times[i] == 0 && up < std::cos(kFallen)) times[i] = step * kDt;
    }
  }
  return speedOf(times[kFrom], times[kTo]);
}

double speedIn(const Recording& r) {
  const auto timeOf = [&r](std::size_t body) {
    std::size_t s = 0;
    while (s + 1 < r.steps.size() && r.turnBetween(body, 0, r.steps[s].time) < kFallen) ++s;
    return r.steps[s].time;
  };
  return speedOf(timeOf(kFrom), timeOf(kTo));
}

}  // namespace

void buildDominoes(SceneWorld& world, const SceneOptions& options) {
  const std::size_t domino =
      world.addSolid(*makeBox({kThick, kWide, kHeight}), options.spheres, progressOf(options, 0, 1));
  world.addGround(0);
  for (int i = 0; i < kDominoes; ++i) {
    world.addBody(domino, kDensity, placeOfDomino(i), paletteColour(static_cast<std::size_t>(i)));
  }
  const double speed = speedOfBullets();
  world.expect({"speed of the wave", "m/s", Truth::Kind::equal, speed, 0.05 * speed,
                "that of Bullet's own boxes in steps of 1/960 s; 5 %", speedIn, kSeconds});
  world.expect({"dominoes that fell", "", Truth::Kind::equal, kDominoes, 0, "each knocks over the next",
                [](const Recording& r) {
                  double fallen = 0;
                  for (std::size_t i = 1; i < kDominoes; ++i)
                    fallen += r.turnBetween(i, 0, r.seconds()) > kFallen;
                  return fallen + 1;  // the first one leans from the start
                },
                kSeconds});
  world.film.viewpoint = {0.4, 0.3, 0.45, true};
}

}  // namespace innersphere::demo
