// A slider that hangs by its T in a slot, under a growing load.
#include <algorithm>
#include <cmath>

#include "bullet_math.hpp"
#include "catalogue.hpp"
#include "film/palette.hpp"
#include "innersphere/mesh.hpp"
#include "scene_solids.hpp"
#include "shapes.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

constexpr double kLip = 0.06;    // [m] thickness of what it hangs on
constexpr double kHold = 0.3;    // [s] under each load
constexpr int kLoads = 10;       // 1, 2, 4, ... 512 weights
constexpr double kLength = 0.3;  // [m]

}  // namespace

void buildTSlot(SceneWorld& world, const SceneOptions& options) {
  const Outline slot =
      gridOutline({-0.24, -0.16, -0.06, 0.06, 0.16, 0.24}, {0, kLip, 0.14, 0.2}, {"#####", "#...#", "##.##"});
  const Outline slider = gridOutline({-0.15, -0.05, 0.05, 0.15}, {-0.1, kLip, 0.12}, {"###", ".#."});
  const btQuaternion upright = turn(vec(1, 0, 0), SIMD_HALF_PI);
  const auto addPart = [&](const Outline& outline, std::size_t index, double density) -> btRigidBody& {
    const auto part = makeSolid(prism(outline, kLength), index == 0 ? "slot" : "slider");
    const std::size_t solid = world.addSolid(*part, options.spheres, progressOf(options, index, 2));
    return world.addBody(solid, density, placeOf(*part, btTransform(upright, vec(0, kLength / 2, 0))),
                         paletteColour(index));
  };
  addPart(slot, 0, 0);
  btRigidBody& body = addPart(slider, 1, kDensity);
  world.drive = [&body](double time, double) {
    const int load = std::min(static_cast<int>(time / kHold + 1e-6), kLoads - 1);
    body.activate();
    body.applyCentralForce(body.getGravity() / body.getInvMass() * btScalar(std::exp2(load) - 1));
  };
  const auto sinkAt = [](const Recording& r, double time) {
    return r.first(1).position[2] - r.body(1, r.stepAt(time)).position[2];
  };
  world.expect({"way down under its weight", "m", Truth::Kind::equal, 0, 0.005 * kLength,
                "it hangs on a flat face; 0.5 % of its size",
                [=](const Recording& r) { return sinkAt(r, kHold); }, kHold});
  world.expect(
      {"load that it bears", "weights", Truth::Kind::equal, std::exp2(kLoads - 1), 0,
       "all: solids do not pass through each other; it is out if it sank by the thickness of the lip",
       [=](const Recording& r) {
         double borne = 0;
         for (int load = 0; load < kLoads && sinkAt(r, (load + 1) * kHold) < kLip; ++load)
           borne = std::exp2(load);
         return borne;
       },
       kLoads * kHold});
  world.film.has_ground = false;
  world.film.viewpoint = {0.4, 0.2, 0.45};
}

}  // namespace innersphere::demo
