// Friction on an incline.
#include <cmath>
#include <string>

#include "bullet_math.hpp"
#include "catalogue.hpp"
#include "film/palette.hpp"
#include "innersphere/solids.hpp"
#include "scene_solids.hpp"
#include "world.hpp"

namespace innersphere::demo {

void buildSlide(SceneWorld& world, const SceneOptions& options) {
  constexpr double kAngle = 0.35;                                // [rad] of the incline
  constexpr double kLength = 2.4, kThickness = 0.2, kWidth = 1;  // [m] of it
  constexpr double kEdge = 0.2, kHeight = 0.1;                   // [m] of the boxes
  constexpr double kFractions[] = {0.5, 0.95, 1, 1.05};          // of friction over tan(angle)
  const btQuaternion tilt = turn(vec(0, 1, 0), kAngle);          // down towards +x
  const btVector3 down = quatRotate(tilt, vec(1, 0, 0)), up = quatRotate(tilt, vec(0, 0, 1));
  const std::size_t box =
      world.addSolid(*makeBox({kEdge, kEdge, kHeight}), options.spheres, progressOf(options, 0, 2));
  const std::size_t slab =
      world.addSolid(*makeBox({kLength, kWidth, kThickness}), options.spheres, progressOf(options, 1, 2));
  for (const bool packed : {false, true}) {
    const btVector3 centre = vec(0, packed ? 0.6 : -0.6, 0);
    const btTransform place(tilt, centre);
    btRigidBody& incline =
        packed ? world.addBody(slab, 0, place, {0.80f, 0.77f, 0.72f})
               : world.addFixedBox(vec(kLength, kWidth, kThickness) / 2, place, {0.80f, 0.77f, 0.72f});
    incline.setFriction(1);
    for (int i = 0; i < 4; ++i) {
      const double y = 0.25 * (i - 1.5);
      const btVector3 start =
          centre + btScalar(-0.85) * down + btScalar((kThickness + kHeight) / 2) * up + vec(0, y, 0);
      btRigidBody& body =
          world.addBody(box, 1000, btTransform(tilt, start), paletteColour(static_cast<std::size_t>(i)));
      const double friction = kFractions[i] * std::tan(kAngle);
      body.setFriction(btScalar(friction));
      const double pull = 9.81 * std::sin(kAngle), brake = friction * 9.81 * std::cos(kAngle);
      const bool holds = kFractions[i] >= 1;
      const std::string name = (packed ? "on a packing" : "on Bullet's box") + std::string(", friction ") +
                               std::to_string(kFractions[i]).substr(0, 4) + " of tan(angle)";
      world.expect({"way down after 1 s " + name, "m", Truth::Kind::equal, holds ? 0 : (pull - brake) / 2,
                    holds ? 0.001 : 0.01 * pull / 2,
                    holds ? "no more than friction bears: it holds; 1 mm"
                          : "g (sin - friction cos) t^2 / 2; 1 % of the way without friction",
                    [index = world.indexOf(body), down](const Recording& r) {
                      const Vec3d &a = r.first(index).position, &b = r.body(index, r.stepAt(1)).position;
                      return (b[0] - a[0]) * down.x() + (b[1] - a[1]) * down.y() + (b[2] - a[2]) * down.z();
                    },
                    1});
    }
  }
  world.film.has_ground = false;
  world.film.viewpoint = {0.5, 0.5, 0.45, true};
}

}  // namespace innersphere::demo
