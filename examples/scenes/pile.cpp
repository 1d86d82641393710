#include <cmath>

#include "film/palette.hpp"
#include "random.hpp"
#include "scene.hpp"
#include "scene_solids.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

constexpr int kBodies = 24;
constexpr double kDiagonal = 0.7;    // [m] of each solid's bounding box
constexpr double kDensity = 1000;    // [kg/m^3]
constexpr double kHalfWidth = 0.88;  // [m] of the tray, inside
constexpr double kWallHeight = 0.4;  // [m]
constexpr double kWall = 0.03;       // [m] half the thickness of floor and walls
constexpr Colour kTrayColour{0.80f, 0.77f, 0.72f};

void addTray(SceneWorld& world) {
  const auto at = [](double x, double y, double z) {
    return btTransform(btQuaternion::getIdentity(), btVector3(btScalar(x), btScalar(y), btScalar(z)));
  };
  const auto box = [](double x, double y, double z) {
    return btVector3(btScalar(x), btScalar(y), btScalar(z));
  };
  const double outer = kHalfWidth + 2 * kWall;
  const double half_height = kWallHeight / 2 + kWall;  // down to the underside of the floor
  const double middle = kWallHeight / 2 - kWall;
  world.addFixedBox(box(kHalfWidth, kHalfWidth, kWall), at(0, 0, -kWall), kTrayColour);
  for (const double side : {-1.0, 1.0}) {
    const double centre = side * (kHalfWidth + kWall);
    world.addFixedBox(box(outer, kWall, half_height), at(0, centre, middle), kTrayColour);
    world.addFixedBox(box(kWall, kHalfWidth, half_height), at(centre, 0, middle), kTrayColour);
  }
  world.addGround(-2 * kWall);
}

}  // namespace

void buildPile(SceneWorld& world, const SceneOptions& options) {
  const std::vector<std::size_t> solids =
      addSolids(world, options, {"torus", "link", "bowl", "lbracket", "gear", "nut"}, kDiagonal);
  addTray(world);

  // Layers of five, one in each corner and one in the middle, far enough apart that no two bodies touch at
  // the start however they are turned.
  constexpr double kCorner = 0.51;  // [m] from the middle, along each side
  constexpr double kLayer = 0.72;   // [m]
  constexpr double kPlaces[5][2] = {{-1, -1}, {1, 1}, {0, 0}, {1, -1}, {-1, 1}};
  Random random(options.seed);
  std::vector<std::size_t> kinds;
  for (std::size_t i = 0; i < kBodies; ++i) kinds.push_back(i % solids.size());
  random.shuffle(kinds);
  for (int i = 0; i < kBodies; ++i) {
    const auto& [x, y] = kPlaces[i % 5];
    const btVector3 place(btScalar(kCorner * x), btScalar(kCorner * y), btScalar(0.5 + kLayer * (i / 5)));
    const std::size_t kind = kinds[static_cast<std::size_t>(i)];
    // With few kinds, colours tell bodies apart; with many, kinds.
    const Colour colour = paletteColour(solids.size() < 4 ? static_cast<std::size_t>(i) : kind);
    world.addBody(solids[kind], kDensity, btTransform(random.rotation(), place), colour);
  }
  world.film.viewpoint = {0.5, 0.68, 0.45};
}

}  // namespace innersphere::demo
