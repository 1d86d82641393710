// Solids fall on floors of every kind.
#include <functional>

#include "bullet_math.hpp"
#include "catalogue.hpp"
#include "film/palette.hpp"
#include "floor.hpp"
#include "innersphere/solids.hpp"
#include "random.hpp"
#include "scaled_solid.hpp"
#include "scene_solids.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

constexpr Colour kFloor{0.80f, 0.77f, 0.72f};
constexpr double kHalfThick = 1;  // [m] half of a box that is a floor

void addBoxFloor(SceneWorld& world, double half_x, double half_y) {
  world.addFixedBox(vec(half_x, half_y, kHalfThick), at(0, 0, -kHalfThick), kFloor);
  world.film.has_ground = false;
}

// Gears that lie flat, but for a few degrees, and fall from 0.5 m.
void addGears(SceneWorld& world, const SceneOptions& options) {
  constexpr double kAcross = 0.33, kHeight = 0.5, kApart = 0.6;  // [m]
  constexpr int kGears = 5;
  const auto gear = scaledSolid(makeNamedSolid("gear"), kAcross / 1.04);
  const std::size_t solid = world.addSolid(*gear, options.spheres, progressOf(options, 0, 1));
  const Bounds b = gear->bounds();
  for (int i = 0; i < kGears; ++i) {
    const btQuaternion tilt = turn(vec(1, i, 0), 0.02 * i);
    world.addBody(solid, kDensity,
                  btTransform(tilt, vec(kApart * (i - kGears / 2), 0, kHeight + (b.max[2] - b.min[2]) / 2)),
                  paletteColour(static_cast<std::size_t>(i)));
  }
  expectNoneInFloor(world, 3);
  world.film.viewpoint = {0.2, 0.5, 0.45};
}

}  // namespace

void buildGearBox(SceneWorld& world, const SceneOptions& options) {
  addBoxFloor(world, 2, 0.5);
  addGears(world, options);
}

void buildGearPlane(SceneWorld& world, const SceneOptions& options) {
  world.addGround(0);
  addGears(world, options);
}

void buildGearMesh(SceneWorld& world, const SceneOptions& options) {
  const Mesh floor{{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  world.addFixedMesh(floor, at(0, 0, 0), kFloor);
  world.film.has_ground = false;
  addGears(world, options);
}

// One after the other, and so far apart that none falls on another.
void buildDrops(SceneWorld& world, const SceneOptions& options) {
  constexpr int kColumns = 10, kRows = 8;
  constexpr double kHeight = 3, kSize = 0.35, kApart = 0.8,
                   kLater = 0.02;                         // [m], each of them higher by kLater
  addBoxFloor(world, kApart * kColumns, kApart * kRows);  // so wide that none rolls off
  const std::vector<std::size_t> solids =
      addSolids(world, options, {"torus", "link", "bowl", "lbracket", "gear", "nut", "knot", "bolt"}, kSize);
  Random random(options.seed);
  for (int i = 0; i < kColumns * kRows; ++i) {
    const btVector3 place = vec(kApart * (i % kColumns - (kColumns - 1) / 2.0),
                                kApart * (i / kColumns - (kRows - 1) / 2.0), kHeight + kLater * i);
    const std::size_t kind = static_cast<std::size_t>(i) % solids.size();
    world.addBody(solids[kind], kDensity, btTransform(random.rotation(), place), paletteColour(kind))
        .setRollingFriction(kRollingFriction);
  }
  // The last one falls for sqrt(2 (3 + 1.58) / g) = 0.97 s.
  expectNoneInFloor(world, 2);
  world.film.viewpoint = {0.3, 0.5, 0.45};
}

}  // namespace innersphere::demo
