// A carabiner in a hook that is shaken.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "bullet_math.hpp"
#include "catalogue.hpp"
#include "centre_line.hpp"
#include "film/palette.hpp"
#include "innersphere/mesh.hpp"
#include "scene_solids.hpp"
#include "shapes.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kTube = 0.025;              // [m] radius of all tubes
constexpr double kBend = 0.08, kLong = 0.1;  // [m] of the carabiner: radius of its ends, half its straights
constexpr double kEye = 0.1;                 // [m] radius of the weight's ring
constexpr double kHookBend = 0.09;           // [m] radius of the hook
constexpr double kRate = 1, kStroke = 0.3;   // [1/s], [m]: at its highest it falls faster than bodies do
constexpr double kSeconds = 10;

// Points of an arc in the xy plane.
void addArc(std::vector<Point2>& path, const Point2& centre, double radius, double from, double to) {
  constexpr int kSteps = 24;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = from + (to - from) * i / kSteps;
    path.push_back({centre[0] + radius * std::cos(angle), centre[1] + radius * std::sin(angle)});
  }
}

struct Wire {
  const char* name;
  std::vector<Point2> path;
  bool closed;
};

// All of them upright in the xy plane, y upwards; the seat of the hook is at the origin.
Wire hook() {
  std::vector<Point2> path{{-kHookBend, 0.5}};
  addArc(path, {0, kHookBend}, kHookBend, kPi, 2 * kPi);
  path.push_back({kHookBend, 0.25});
  return {"hook", path, false};
}

Wire carabiner() {
  std::vector<Point2> path;
  addArc(path, {0, kLong}, kBend, 0, kPi);
  addArc(path, {0, -kLong}, kBend, kPi, 2 * kPi);
  return {"carabiner", path, true};
}

Wire eye() {
  std::vector<Point2> path;
  addArc(path, {0, 0}, kEye, 0, 2 * kPi);
  path.pop_back();
  return {"weight", path, true};
}

// A body of this mass [kg], turned about the vertical; `height` is that of the origin of its wire.
CentreLine addWire(SceneWorld& world, const SceneOptions& options, const Wire& wire, double mass,
                   double angle, double height) {
  const std::size_t index = world.solids().size();
  const auto solid =
      makeSolid(tube(wire.path, std::vector<double>(wire.path.size(), kTube), 24, wire.closed), wire.name);
  const std::size_t packed = world.addSolid(*solid, options.spheres, progressOf(options, index, 3));
  const btTransform mesh(turn(vec(0, 0, 1), angle) * turn(vec(1, 0, 0), SIMD_HALF_PI), vec(0, 0, height));
  const btRigidBody& body = world.addBody(packed, mass / solid->massProperties().volume,
                                          placeOf(*solid, mesh), paletteColour(index));
  std::vector<Vec3d> points;
  for (const Point2& p : wire.path) points.push_back({p[0], p[1], 0});
  return centreLineOf(world, world.indexOf(body), points, wire.closed);
}

void expectHung(SceneWorld& world, const std::array<CentreLine, 3>& wires, double taut) {
  world.expect({"deepest overlap of two tubes, over their radius", "", Truth::Kind::at_most, 0.1, 0,
                "they are hard; 10 %",
                [=](const Recording& r) {
                  double nearest = 2 * kTube;
                  for (std::size_t s = 0; s < r.steps.size(); ++s) {
                    for (const int i : {0, 1})
                      nearest = std::min(nearest, distanceOf(wires[i], wires[i + 1], r, s));
                  }
                  return (2 * kTube - nearest) / kTube;
                },
                kSeconds});
  world.expect({"farthest that the weight gets from the hook, over where it hangs", "", Truth::Kind::at_most,
                1.01, 0, "no tube passes through another; 1 %",
                [=, from = world.bodies()[0].body->getWorldTransform().getOrigin()](const Recording& r) {
                  double farthest = 0;
                  for (std::size_t s = 0; s < r.steps.size(); ++s) {
                    const Vec3d &a = r.body(0, s).position, &b = r.body(2, s).position;
                    const double seat = a[2] - from.z();  // the hook starts with its seat at height 0
                    farthest = std::max(farthest, std::hypot(b[0], b[1], b[2] - seat));
                  }
                  return farthest / taut;
                },
                kSeconds});
}

}  // namespace

void buildCarabiner(SceneWorld& world, const SceneOptions& options) {
  const double middle = 2 * kTube - (kBend + kLong);  // where the carabiner's is, below the seat of the hook
  const double low = middle - (kBend + kLong) + 2 * kTube - kEye;
  const std::array<CentreLine, 3> wires = {addWire(world, options, hook(), 0, 0, 0),
                                           addWire(world, options, carabiner(), 1, kPi / 2, middle),
                                           addWire(world, options, eye(), 10, 0, low)};
  btRigidBody& holder = *world.bodies()[0].body;
  makeKinematic(holder);
  world.drive = [&holder, start = holder.getWorldTransform()](double time, double dt) {
    btTransform place = start;
    place.getOrigin() += vec(0, 0, kStroke * (1 - std::cos(2 * kPi * kRate * (time + dt))));
    holder.setWorldTransform(place);
  };
  expectHung(world, wires, -low);
  world.film.has_ground = false;
  world.film.viewpoint = {0.6, 0.2, 0.45, true};
}

}  // namespace innersphere::demo
