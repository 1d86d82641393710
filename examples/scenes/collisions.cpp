// Impacts in free space.
#include <cmath>
#include <string>

#include "bullet_math.hpp"
#include "catalogue.hpp"
#include "film/palette.hpp"
#include "innersphere/solids.hpp"
#include "measures.hpp"
#include "scene_solids.hpp"
#include "world.hpp"

namespace innersphere::demo {
namespace {

constexpr double kRadius = 0.2;  // [m]
constexpr double kSpeed = 1;     // [m/s]

Measure velocityAlong(std::size_t body, const btVector3& direction) {
  return [=](const Recording& r) {
    const Vec3d& v = r.last(body).velocity;
    return v[0] * direction.x() + v[1] * direction.y() + v[2] * direction.z();
  };
}

// Change of a sum over all bodies, relative to `scale`.
Truth kept(const std::string& what, Vec3d StepRecord::*sum, double scale, double limit) {
  return {what, "", Truth::Kind::at_most, limit, 0, "it is kept", [=](const Recording& r) {
            const Vec3d &a = r.steps.front().*sum, &b = r.steps.back().*sum;
            return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]) / scale;
          }};
}

struct Pair {
  const char* name;
  double density;  // of the ball that is hit; the other has 1000 kg/m^3
  double restitution;
  double offset;  // of the centres, across the motion, in diameters
};

// The ball on the left flies into the one on the right, which is at rest.
void addPair(SceneWorld& world, std::size_t ball, int row, const Pair& pair) {
  const double y = 1.2 * row;
  const double sine = pair.offset;  // of the angle between motion and line of centres
  const btVector3 normal = vec(std::sqrt(1 - sine * sine), sine, 0), across = vec(-sine, normal.x(), 0);
  btRigidBody& a = world.addBody(ball, 1000, at(-1, y, 0), paletteColour(0));
  btRigidBody& b = world.addBody(ball, pair.density, at(0, y + 2 * kRadius * sine, 0), paletteColour(1));
  for (btRigidBody* body : {&a, &b}) {
    body->setFriction(0);
    body->setRestitution(btScalar(std::sqrt(pair.restitution)));  // Bullet multiplies the two
  }
  a.setLinearVelocity(vec(kSpeed, 0, 0));
  const double m1 = 1000, m2 = pair.density, v = kSpeed * normal.x();
  const std::string name = pair.name;
  const auto expect = [&](const std::string& what, const btRigidBody& body, const btVector3& along,
                          double value) {
    world.expect({what + ", " + name, "m/s", Truth::Kind::equal, value, 0.01 * kSpeed,
                  "impact of smooth balls: momentum along the line of centres, restitution",
                  velocityAlong(world.indexOf(body), along), 1.5});
  };
  expect("speed of the hitting ball along the normal", a, normal,
         (m1 - pair.restitution * m2) / (m1 + m2) * v);
  expect("speed of the ball that is hit along the normal", b, normal,
         (1 + pair.restitution) * m1 / (m1 + m2) * v);
  if (sine != 0) expect("speed of the hitting ball across", a, across, kSpeed * across.x());
}

}  // namespace

void buildCollisions(SceneWorld& world, const SceneOptions& options) {
  world.bullet().setGravity(vec(0, 0, 0));
  const std::size_t ball = world.addSolid(*makeBall(kRadius), options.spheres, progressOf(options, 0, 1));
  const Pair pairs[] = {{"equal balls, e = 1", 1000, 1, 0},
                        {"1 : 3, e = 0.5", 3000, 0.5, 0},
                        {"glancing, e = 1", 1000, 1, 0.5},
                        {"glancing, e = 0", 1000, 0, 0.5}};
  int row = 0;
  for (const Pair& pair : pairs) addPair(world, ball, row++, pair);
  const double momentum = 4 * 1000 * 4.0 / 3 * 3.14159265 * std::pow(kRadius, 3) * kSpeed;
  world.expect(kept("change of the momentum", &StepRecord::momentum, momentum, 1e-5));
  world.expect(
      kept("change of the angular momentum", &StepRecord::angular_momentum, momentum * kRadius, 1e-3));
  world.film.has_ground = false;
  world.film.viewpoint = {0.3, 0.7, 0.5, true};
}

void buildTumble(SceneWorld& world, const SceneOptions& options) {
  world.bullet().setGravity(vec(0, 0, 0));
  const std::size_t bracket = addSolids(world, options, {"lbracket"}, 0.8).front();
  btRigidBody& a =
      world.addBody(bracket, 1000, btTransform(turn(vec(1, 2, 3), 1), vec(-0.8, 0, 0)), paletteColour(0));
  btRigidBody& b =
      world.addBody(bracket, 500, btTransform(turn(vec(3, 1, 0), 2), vec(0.8, 0.1, 0.15)), paletteColour(1));
  a.setLinearVelocity(vec(1, 0, 0));
  b.setLinearVelocity(vec(-2, 0, 0));
  b.setAngularVelocity(vec(0, 1, 2));
  const double momentum = 1 / double(a.getInvMass()) + 2 / double(b.getInvMass());
  world.expect(kept("change of the momentum", &StepRecord::momentum, momentum, 1e-5));
  world.expect(kept("change of the angular momentum", &StepRecord::angular_momentum, momentum * 0.25, 0.01));
  world.expect({"energy afterwards over energy before", "", Truth::Kind::at_most, 1, 0, "an impact adds none",
                [](const Recording& r) { return r.steps.back().energy() / r.steps.front().energy(); }});
  world.film.has_ground = false;
  world.film.viewpoint = {0.3, 0.4, 0.5, true};
}

}  // namespace innersphere::demo
