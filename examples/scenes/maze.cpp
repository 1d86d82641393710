// A ball in a maze.
#include <algorithm>
#include <cmath>
#include <vector>

#include "bullet_math.hpp"
#include "catalogue.hpp"
#include "film/palette.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/solids.hpp"
#include "measures.hpp"
#include "scene_solids.hpp"
#include "shapes.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

constexpr double kHalfWidth = 1, kWall = 0.08;   // [m]
constexpr double kReach = 1.6;                   // [m] of a shelf
constexpr double kFall = 0.25;                   // of a shelf, over its reach
constexpr double kStorey = 0.8, kHeight = 0.35;  // [m] from shelf to shelf; of the walls
constexpr double kBall = 0.12;                   // [m] radius

// A wall along y on the left with `shelves` shelves that come down towards the right, the first one's top at
// y = 0; a floor at its lower end if asked for.
Outline comb(int shelves, double top, double bottom) {
  Outline outline;
  const double inner = -kHalfWidth, outer = -kHalfWidth - kWall;
  std::uint32_t left = outline.add({outer, top}), right = outline.add({inner, top});
  for (int i = 0; i < shelves; ++i) {
    const double y = -2 * kStorey * i;
    const std::uint32_t high = outline.add({inner, y}), high_left = outline.add({outer, y});
    const std::uint32_t low = outline.add({inner, y - kWall}), low_left = outline.add({outer, y - kWall});
    const std::uint32_t tip = outline.add({inner + kReach, y - kFall * kReach});
    const std::uint32_t under = outline.add({inner + kReach, y - kFall * kReach - kWall});
    outline.addQuad(left, high_left, high, right);
    outline.addQuad(high_left, low_left, low, high);
    outline.addQuad(high, low, under, tip);
    left = low_left, right = low;
  }
  outline.addQuad(left, outline.add({outer, bottom}), outline.add({inner, bottom}), right);
  return outline;
}

Outline mirrored(Outline outline, double down) {
  for (Point2& p : outline.points) p = {-p[0], p[1] - down};
  for (auto& t : outline.triangles) std::swap(t[1], t[2]);
  return outline;
}

btVector3 centreOf(const Bounds& b) {
  return vec((b.min[0] + b.max[0]) / 2, (b.min[1] + b.max[1]) / 2, (b.min[2] + b.max[2]) / 2);
}

}  // namespace

void buildMaze(SceneWorld& world, const SceneOptions& options) {
  constexpr int kShelves = 2;  // on each side
  constexpr double kTop = 0.6, kBottom = -4 * kStorey;
  constexpr double kSlope = 0.5;  // [rad] of the board against the horizontal
  world.bullet().setGravity(9.81 * vec(0, -std::sin(kSlope), -std::cos(kSlope)));
  const Outline left = comb(kShelves, kTop, kBottom);
  const Outline right = mirrored(comb(kShelves, kTop + kStorey, kBottom + kStorey), kStorey);
  Outline end;
  end.addQuad(end.add({-kHalfWidth, kBottom}), end.add({kHalfWidth, kBottom}),
              end.add({kHalfWidth, kBottom + kWall}), end.add({-kHalfWidth, kBottom + kWall}));
  std::size_t part = 0;
  world.addGround(0);
  for (const Outline& outline : {left, right, end}) {
    const auto solid = makeSolid(prism(outline, kHeight), "walls of a maze");
    const std::size_t walls = world.addSolid(*solid, options.spheres, progressOf(options, part++, 4));
    world.addBody(walls, 0, btTransform(btQuaternion::getIdentity(), centreOf(solid->bounds())),
                  {0.80f, 0.77f, 0.72f});
  }
  const std::size_t ball = world.addSolid(*makeBall(kBall), options.spheres, progressOf(options, 3, 4));
  btRigidBody& body = world.addBody(ball, 1000, at(-kHalfWidth + 0.3, 0.3, kBall), paletteColour(0));
  const std::size_t index = world.indexOf(body);
  world.expect({"where the ball ends, along the way down", "m", Truth::Kind::equal, kBottom + kWall + kBall,
                0.005 * 2 * kBall, "on the last wall, a radius above it; 0.5 % of its size",
                finalCoordinate(index, 1), 14});
  world.expect({"storeys that the ball rolled along", "", Truth::Kind::equal, 2 * kShelves, 0,
                "it passes the tip of each shelf, on alternating sides",
                [index](const Recording& r) {
                  int passed = 0;
                  for (std::size_t s = 0; s < r.steps.size(); ++s) {
                    const Vec3d& p = r.body(index, s).position;
                    const double side = passed % 2 == 0 ? 1 : -1;
                    const double tip = -kStorey * passed - kFall * kReach;
                    if (passed < 2 * kShelves && side * p[0] > kReach - kHalfWidth && p[1] < tip) ++passed;
                  }
                  return double(passed);
                },
                14});
  world.expect({"highest place of the ball above the board", "m", Truth::Kind::at_most, kHeight, 0,
                "it stays between the walls", [index](const Recording& r) {
                  double highest = 0;
                  for (std::size_t s = 0; s < r.steps.size(); ++s)
                    highest = std::max(highest, r.body(index, s).position[2]);
                  return highest;
                }});
  world.film.viewpoint = {0.1, 1.1, 0.5, true};
}

}  // namespace innersphere::demo
