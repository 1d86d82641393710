// Piles of mixed solids in a tray.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "bullet_math.hpp"
#include "catalogue.hpp"
#include "film/palette.hpp"
#include "floor.hpp"
#include "measures.hpp"
#include "random.hpp"
#include "scans.hpp"
#include "scene_solids.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

constexpr double kDiagonal = 0.7;  // [m] of each solid's bounding box
constexpr double kWall = 0.03;     // [m] half the thickness of floor and walls
constexpr Colour kTrayColour{0.80f, 0.77f, 0.72f};
const std::vector<std::string> kSixKinds = {"torus", "link", "bowl", "lbracket", "gear", "nut"};

struct Tray {
  double half_width;  // [m] inside
  double height;      // [m]
};

void addTray(SceneWorld& world, const Tray& tray) {
  const double outer = tray.half_width + 2 * kWall;
  const double half_height = tray.height / 2 + kWall;  // down to the underside of the floor
  const double middle = tray.height / 2 - kWall;
  const auto addBox = [&world](const btVector3& half_size, const btTransform& place) {
    world.addFixedBox(half_size, place, kTrayColour).setRollingFriction(kRollingFriction);
  };
  addBox(vec(tray.half_width, tray.half_width, kWall), at(0, 0, -kWall));
  for (const double side : {-1.0, 1.0}) {
    const double centre = side * (tray.half_width + kWall);
    addBox(vec(outer, kWall, half_height), at(0, centre, middle));
    addBox(vec(kWall, tray.half_width, half_height), at(centre, 0, middle));
  }
  world.addGround(-2 * kWall);
}

// Bodies that leave the tray lie on the ground, which is lower by its floor.
std::function<double(double, double)> floorOf(const Tray& tray) {
  const double outer = tray.half_width + 2 * kWall;
  return [outer](double x, double y) { return std::max(std::abs(x), std::abs(y)) < outer ? 0 : -2 * kWall; };
}

// Bodies in layers: one at each of these places of a layer, far enough apart that no two touch at the start
// however they are turned.
void addPile(SceneWorld& world, const SceneOptions& options, std::size_t count,
             const std::vector<std::size_t>& solids, const std::vector<std::array<double, 2>>& places) {
  constexpr double kLayer = 0.72;  // [m]
  Random random(options.seed);
  std::vector<std::size_t> kinds;
  for (std::size_t i = 0; i < count; ++i) kinds.push_back(i % solids.size());
  random.shuffle(kinds);
  for (std::size_t i = 0; i < count; ++i) {
    const auto& [x, y] = places[i % places.size()];
    const btVector3 place = vec(x, y, 0.5 + kLayer * static_cast<double>(i / places.size()));
    const std::size_t kind = kinds[i];
    // With few kinds, colours tell bodies apart; with many, kinds.
    const Colour colour = paletteColour(solids.size() < 4 ? i : kind);
    world.addBody(solids[kind], kDensity, btTransform(random.rotation(), place), colour)
        .setRollingFriction(kRollingFriction);
  }
  world.film.viewpoint = {0.5, 0.95, 0.45};  // over the walls
}

std::vector<std::array<double, 2>> gridOfNine() {
  constexpr double kApart = 0.75;  // [m]
  std::vector<std::array<double, 2>> places;
  for (int i = 0; i < 9; ++i) places.push_back({kApart * (i % 3 - 1), kApart * (i / 3 - 1)});
  return places;
}

void expectRest(SceneWorld& world, double seconds, double known_miss = 0) {
  std::vector<double> sizes;  // of the bodies; the tray's are 0
  for (const SceneBody& body : world.bodies()) sizes.push_back(body.moves() ? body.size : 0);
  const auto count =
      static_cast<double>(std::count_if(sizes.begin(), sizes.end(), [](double s) { return s > 0; }));
  world
      .expect({"largest motion in the last half second, over the body's size", "", Truth::Kind::at_most,
               kRestMotion, 0, "nothing is seen to move; turning by an angle counts as half of it",
               [sizes](const Recording& r) {
                 const std::vector<double> motions = motionsAtTheEnd(r, sizes);
                 return *std::max_element(motions.begin(), motions.end());
               },
               seconds})
      .known_miss = known_miss;
  world.expect({"bodies that are seen to move in the last half second", "", Truth::Kind::at_most,
                std::floor(count / 20), 0, "where one slips, one of twenty at most moves with it",
                [sizes](const Recording& r) {
                  const std::vector<double> motions = motionsAtTheEnd(r, sizes);
                  return static_cast<double>(std::count_if(
                      motions.begin(), motions.end(), [](double motion) { return motion > kRestMotion; }));
                },
                seconds});
  world.expect({"bodies that fell through the floor", "", Truth::Kind::equal, 0, 0, "none leaks out",
                [sizes](const Recording& r) {
                  double below = 0;
                  for (std::size_t i = 0; i < sizes.size(); ++i)
                    below += sizes[i] > 0 && r.last(i).position[2] < -2 * kWall;  // the ground outside
                  return below;
                }});
  world.expect({"deepest overlap at the end, over the body's size", "", Truth::Kind::at_most, 0.005, 0,
                "bodies rest on each other, not in each other",
                [](const Recording& r) { return r.steps.back().relative_overlap; }, seconds});
}

}  // namespace

void buildPile(SceneWorld& world, const SceneOptions& options) {
  constexpr double kCorner = 0.51;  // [m] from the middle, along each side
  constexpr Tray kTray{0.88, 0.6};
  addTray(world, kTray);
  addPile(world, options, 24, addSolids(world, options, kSixKinds, kDiagonal),
          {{-kCorner, -kCorner}, {kCorner, kCorner}, {0, 0}, {kCorner, -kCorner}, {-kCorner, kCorner}});
  expectRest(world, 5);
}

void buildLargePile(SceneWorld& world, const SceneOptions& options) {
  constexpr Tray kTray{1.6, 0.8};
  addTray(world, kTray);
  std::vector<std::array<double, 2>> places;
  for (int i = 0; i < 16; ++i) places.push_back({0.75 * (i % 4 - 1.5), 0.75 * (i / 4 - 1.5)});
  addPile(world, options, 100, addSolids(world, options, kSixKinds, kDiagonal), places);
  expectRest(world, 13, 0.06);  // one slips or tips over now and then
}

void buildPile50(SceneWorld& world, const SceneOptions& options) {
  constexpr Tray kTray{1.2, 0.8};
  addTray(world, kTray);
  std::vector<std::string> kinds = kSixKinds;
  kinds.insert(kinds.end(), {"knot", "bolt"});
  addPile(world, options, 50, addSolids(world, options, kinds, kDiagonal), gridOfNine());
  expectRest(world, 10);
  expectNoneInFloor(world, floorOf(kTray), 4);
}

void buildScanBin(SceneWorld& world, const SceneOptions& options) {
  constexpr Tray kTray{1.2, 0.8};
  addTray(world, kTray);
  addPile(world, options, 16, addSolids(world, options, scans(), kDiagonal), gridOfNine());
  expectRest(world, 8);
  expectNoneInFloor(world, floorOf(kTray), 3);
}

}  // namespace innersphere::demo
