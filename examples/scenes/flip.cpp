// Free rotation.
#include <cmath>
#include <vector>

#include "bullet_math.hpp"
#include "catalogue.hpp"
#include "film/palette.hpp"
#include "innersphere/solids.hpp"
#include "scene_solids.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

// The component of the spin along an axis of the body, after a step.
double spinAlong(const BodyState& state, const btVector3& axis) {
  const btQuaternion q(btScalar(state.rotation[0]), btScalar(state.rotation[1]), btScalar(state.rotation[2]),
                       btScalar(state.rotation[3]));
  return quatRotate(q, axis).dot(vec(state.spin[0], state.spin[1], state.spin[2]));
}

// The mean time between changes of sign of the spin along `axis`.
double timeBetweenFlips(const Recording& r, const btVector3& axis) {
  std::vector<double> times;
  for (std::size_t i = 1; i < r.steps.size(); ++i) {
    const double before = spinAlong(r.body(0, i - 1), axis), after = spinAlong(r.body(0, i), axis);
    if ((before > 0) == (after > 0)) continue;
    const double t = before / (before - after);
    times.push_back(r.steps[i - 1].time + t * (r.steps[i].time - r.steps[i - 1].time));
  }
  if (times.size() < 2) return std::nan("");
  return (times.back() - times.front()) / static_cast<double>(times.size() - 1);
}

}  // namespace

void buildFlip(SceneWorld& world, const SceneOptions& options) {
  constexpr double a = 0.6, b = 0.4, c = 0.2;  // [m]
  constexpr double kSpin = 10, kNudge = 0.5;   // [rad/s]
  world.bullet().setGravity(vec(0, 0, 0));
  const std::size_t box = world.addSolid(*makeBox({a, b, c}), options.spheres, progressOf(options, 0, 1));
  btRigidBody& body = world.addBody(box, 1000, at(0, 0, 0), paletteColour(0));
  body.setAngularVelocity(vec(kNudge, kSpin, 0));

  // Moments of a box per mass; motion of a free top: Landau and Lifshitz, Mechanics, section 37.
  const double i1 = (b * b + c * c) / 12, i2 = (a * a + c * c) / 12, i3 = (a * a + b * b) / 12;
  const double twice_energy = i1 * kNudge * kNudge + i2 * kSpin * kSpin;
  const double square = std::pow(i1 * kNudge, 2) + std::pow(i2 * kSpin, 2);  // of the angular momentum
  // The spin about the middle axis swings between its extremes in half a period. Where L^2 < 2 E I2 the axes
  // 1 and 3 change their parts.
  const bool swap = square < twice_energy * i2;
  const double low = swap ? i3 : i1, high = swap ? i1 : i3;
  const double rate = std::sqrt((high - i2) * (square - twice_energy * low) / (i1 * i2 * i3));
  const double k2 =
      (i2 - low) * (twice_energy * high - square) / ((high - i2) * (square - twice_energy * low));
  const double expected = 2 * std::comp_ellint_1(std::sqrt(k2)) / rate;
  // Bullet's axes are the solid's, in an order of its own: the middle one is what was spun about.
  const btVector3 axis = quatRotate(body.getWorldTransform().getRotation().inverse(), vec(0, 1, 0));
  world.expect({"time between flips", "s", Truth::Kind::equal, expected, 0.01 * expected,
                "2 K(k) / rate of the free top (Landau, Lifshitz: Mechanics, section 37)",
                [axis](const Recording& r) { return timeBetweenFlips(r, axis); }, 2.2 * expected});
  const double momentum = std::sqrt(square) / double(body.getInvMass());
  world.expect({"change of the angular momentum", "", Truth::Kind::at_most, 0.01, 0, "it is kept",
                [momentum](const Recording& r) {
                  const Vec3d &l = r.steps.back().angular_momentum, &l0 = r.steps.front().angular_momentum;
                  return std::hypot(l[0] - l0[0], l[1] - l0[1], l[2] - l0[2]) / momentum;
                }});
  // Bullet turns free bodies by one step of an implicit Euler method, which takes energy in proportion to the
  // step: 2.8 % in 5 s at 1,000 steps/s, 1.4 % at 2,000, 0.7 % at 4,000.
  world.expect({"change of the energy", "", Truth::Kind::equal, 0, 0.01, "it is kept",
                [](const Recording& r) { return r.steps.back().energy() / r.steps.front().energy() - 1; }});
  world.film.has_ground = false;
  world.film.viewpoint = {0.4, 0.3, 0.45, true};
}

}  // namespace innersphere::demo
