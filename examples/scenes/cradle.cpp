// Newton's cradle.
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

void buildCradle(SceneWorld& world, const SceneOptions& options) {
  constexpr int kBalls = 5;
  // The gap is more than a ball moves in a step, so that impacts come one after the other.
  constexpr double kRadius = 0.1, kString = 1, kGap = 0.002;  // [m]
  constexpr double kLift = 0.6;                               // [rad] of the first ball
  const std::size_t ball = world.addSolid(*makeBall(kRadius), options.spheres, progressOf(options, 0, 1));
  for (int i = 0; i < kBalls; ++i) {
    const double pivot = (2 * kRadius + kGap) * (i - kBalls / 2);
    const btQuaternion swing = turn(vec(0, 1, 0), i == 0 ? kLift : 0);
    const btVector3 hang = quatRotate(swing, vec(0, 0, -kString));
    btRigidBody& body = world.addBody(ball, 1000, btTransform(swing, vec(pivot, 0, kString) + hang),
                                      paletteColour(static_cast<std::size_t>(i)));
    body.setRestitution(1);
    body.setFriction(0);
    // A string as a rigid rod that turns about the y axis: every ball is the same pendulum.
    const btVector3 axis = quatRotate(body.getWorldTransform().getRotation().inverse(), vec(0, 1, 0));
    const btVector3 up = quatRotate(body.getWorldTransform().getRotation().inverse(), -hang);
    btVector3 axis_in_body = axis;
    world.addConstraint(std::make_unique<btHingeConstraint>(body, up, axis_in_body));
  }
  const double height = kString * (1 - std::cos(kLift));
  const auto rise = [](std::size_t i, double from) {
    return [=](const Recording& r) {
      double highest = -1;
      for (std::size_t s = r.stepAt(from); s < r.steps.size(); ++s)
        highest = std::max(highest, r.body(i, s).position[2]);
      return highest;
    };
  };
  world.expect({"rise of the last ball", "m", Truth::Kind::equal, height, 0.05 * height,
                "as high as the first one was: equal balls swap their speeds", rise(kBalls - 1, 0.3), 1.5});
  world.expect({"rise of the first ball when the last one comes back", "m", Truth::Kind::equal, height,
                0.05 * height, "the same the other way", rise(0, 1.5), 2.3});
  for (std::size_t i = 1; i < kBalls - 1; ++i) {
    world.expect({"rise of ball " + std::to_string(i + 1), "m", Truth::Kind::equal, 0, 0.05 * height,
                  "it stays", rise(i, 0.3), 1.5});
  }
  world.film.has_ground = false;
  world.film.viewpoint = {0.2, 0.15, 0.45, true};
}

}  // namespace innersphere::demo
