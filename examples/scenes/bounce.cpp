// Restitution.
#include <algorithm>
#include <cmath>
#include <memory>

#include "bullet_math.hpp"
#include "catalogue.hpp"
#include "film/palette.hpp"
#include "innersphere/solids.hpp"
#include "scene_solids.hpp"
#include "world.hpp"

namespace innersphere::demo {

void buildBounce(SceneWorld& world, const SceneOptions& options) {
  constexpr double kHeight = 1;  // [m] of the fall
  const double fall = std::sqrt(2 * kHeight / 9.81);
  struct Jumper {
    const char* name;
    std::shared_ptr<const Solid> solid;
    double restitution;
  };
  const Jumper jumpers[] = {{"ball, e = 1", makeBall(0.2), 1},
                            {"ball, e = 0.5", makeBall(0.2), 0.5},
                            {"box, e = 0.5", makeBox({0.4, 0.4, 0.4}), 0.5},
                            {"torus, e = 0.5", makeTorus(0.2, 0.08), 0.5}};
  world.addGround(0).setRestitution(1);
  std::size_t i = 0;
  for (const auto& [name, solid, e] : jumpers) {
    const std::size_t packed =
        world.addSolid(*solid, options.spheres, progressOf(options, i, std::size(jumpers)));
    const double half = (solid->bounds().max[2] - solid->bounds().min[2]) / 2;
    const double x = 0.7 * (static_cast<double>(i) - 1.5);
    btRigidBody& body = world.addBody(packed, 1000, at(x, 0, half + kHeight), paletteColour(i));
    body.setRestitution(btScalar(e));
    const std::size_t index = world.indexOf(body);
    world.expect({"rebound of the " + std::string(name), "m", Truth::Kind::equal, e * e * kHeight,
                  0.03 * kHeight,
                  "e^2 h, Newton's restitution; 3 % of h, for the speed at impact is known to g dt",
                  [=](const Recording& r) {
                    double highest = 0;
                    for (std::size_t s = r.stepAt(1.1 * fall); s < r.steps.size(); ++s) {
                      highest = std::max(highest, r.body(index, s).position[2] - half);
                    }
                    return highest;
                  },
                  fall * (1 + 1.1 * e)});
    ++i;
  }
  world.film.viewpoint = {0.2, 0.15, 0.45, true};
}

}  // namespace innersphere::demo
