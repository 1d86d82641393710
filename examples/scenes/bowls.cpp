// Nested bowls.
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

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

constexpr double kOuter = 0.5, kInner = 0.42, kRim = (kOuter - kInner) / 2;  // [m]

// Half a spherical shell with a round rim, open upwards, the centre of the spheres at the origin.
Mesh bowl() {
  constexpr int kArc = 30, kRimSteps = 10, kAround = 96;
  std::vector<Point2> profile;
  const auto arc = [&](double centre, double radius, double from, double to, int steps) {
    for (int i = 0; i <= steps; ++i) {
      const double angle = from + (to - from) * i / steps;
      profile.push_back({centre + radius * std::cos(angle), radius * std::sin(angle)});
    }
  };
  constexpr double kPi = std::numbers::pi;
  arc(0, kOuter, -kPi / 2, 0, kArc);
  profile.pop_back();
  arc(kOuter - kRim, kRim, 0, kPi, kRimSteps);
  profile.pop_back();
  arc(0, kInner, 0, -kPi / 2, kArc);
  profile.front()[0] = profile.back()[0] = 0;
  return lathe(profile, kAround);
}

}  // namespace

void buildBowls(SceneWorld& world, const SceneOptions& options) {
  constexpr std::size_t kBowls = 5;
  constexpr double kDrop = 0.05;  // [m] of each bowl onto the one below it
  const std::size_t shape =
      world.addSolid(*makeSolid(bowl(), "bowl"), options.spheres, progressOf(options, 0, 1));
  // A sphere in a ring: the rim is a torus, and the bowl in it touches it all around.
  const double nested = std::sqrt(std::pow(kOuter + kRim, 2) - std::pow(kOuter - kRim, 2));
  world.addGround(0);
  double energy = 0;
  for (std::size_t i = 0; i < kBowls; ++i) {
    const double number = static_cast<double>(i);
    // The bounding box is from the bottom to the top of the rim.
    // The first one is held: a tower on a round bottom would fall over.
    const btRigidBody& body =
        world.addBody(shape, i == 0 ? 0 : 1000, at(0, 0, (kOuter + kRim) / 2 + number * (nested + kDrop)),
                      paletteColour(i));
    if (i == 0) continue;
    energy += number * kDrop * 9.81 / double(body.getInvMass());
    world.expect({"height of bowl " + std::to_string(i + 1) + " above the first", "m", Truth::Kind::equal,
                  number * nested, 0.005 * number * nested,
                  "outer sphere in the torus of the rim: sqrt((R + r)^2 - (R - r)^2) each; 0.5 %",
                  [i](const Recording& r) { return r.last(i).position[2] - r.last(0).position[2]; }, 4});
  }
  world.expect(energyGainBelow(0.13, energy, "the fall to where they rest"));
  world.film.viewpoint = {0.4, 0.15, 0.45};
}

}  // namespace innersphere::demo
